// The arrows between the folders: app -> scenes -> physics, scenes -> render, app -> render, and
// every third-party package behind the files that may know it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace tests {
namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;  // relative to the source tree
  std::string what;
};

std::vector<Include> findIncludes(const std::string& folder) {
  static const std::regex kLine(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"].*)");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(DBD_SOURCE) / folder)) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    std::ifstream file(entry.path());
    std::smatch match;
    for (std::string line; std::getline(file, line);) {
      if (std::regex_match(line, match, kLine)) {
        includes.push_back({fs::relative(entry.path(), DBD_SOURCE), match[1]});
      }
    }
  }
  return includes;
}

bool startsWith(const std::string& text, const std::string& head) {
  return text.rfind(head, 0) == 0;
}

class Arrows : public testing::TestWithParam<std::pair<std::string, std::set<std::string>>> {};

TEST_P(Arrows, AFolderIncludesOnlyWhatItMayKnow) {
  const auto& [folder, allowed] = GetParam();
  const std::vector<Include> includes = findIncludes(folder);
  ASSERT_FALSE(includes.empty());
  for (const Include& include : includes) {
    for (const std::string other : {"physics", "render", "scenes", "app", "tests"}) {
      if (!startsWith(include.what, other + "/")) continue;
      EXPECT_TRUE(allowed.contains(other)) << include.file << " includes " << include.what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Folders, Arrows,
    testing::Values(std::pair("physics", std::set<std::string>{"physics"}),
                    std::pair("render", std::set<std::string>{"render"}),
                    std::pair("scenes", std::set<std::string>{"scenes", "physics", "render"}),
                    std::pair("app", std::set<std::string>{"app", "scenes", "physics", "render"})),
    [](const auto& info) { return info.param.first; });

// The rooms of physics/ from bottom to top: a file includes what is in its own room or below it.
const std::vector<std::string> kRooms = {
    "base",   "bodies",  "collision", "constraints", "kinematics", "motion",
    "solver", "model",   "accurate",  "small_steps", "sweep",      "rivals",
    "state",  "effects", "stepping",  "world",       "make"};

// -1: in none. physics/world.h and physics/world.cpp are of the room that their name says.
int roomOf(const std::string& path) {
  std::smatch match;
  static const std::regex kRoom(R"(physics/(?:(\w+)/\w+\.(?:h|cpp)|(world)\.(?:h|cpp)))");
  if (!std::regex_match(path, match, kRoom)) return -1;
  const auto found = std::find(kRooms.begin(), kRooms.end(), match[1].str() + match[2].str());
  return found == kRooms.end() ? -1 : static_cast<int>(found - kRooms.begin());
}

TEST(Rooms, IncludeOnlyWhatIsBelowThem) {
  for (const Include& include : findIncludes("physics")) {
    if (!startsWith(include.what, "physics/")) continue;
    EXPECT_LE(roomOf(include.what), roomOf(include.file.string()))
        << include.file << " includes " << include.what;
    EXPECT_GE(roomOf(include.what), 0) << include.file << " includes " << include.what;
  }
}

TEST(Rooms, HoldEveryFileOfPhysics) {
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(DBD_SOURCE) / "physics")) {
    const std::string ending = entry.path().extension().string();
    if (ending != ".h" && ending != ".cpp") continue;
    EXPECT_GE(roomOf(fs::relative(entry.path(), DBD_SOURCE).string()), 0) << entry.path();
  }
}

// How an include begins, and the files that may have it: how their paths begin.
const std::map<std::string, std::vector<std::string>> kPackages = {
    {"fcl/", {"physics/collision/"}},
    {"GL/", {"render/"}},
    {"imgui", {"render/"}},
    {"stb_", {"render/png.cpp"}},
    {"libdeflate", {"render/png", "app/base/npz", "app/take/numbers"}},
    {"tiny_gltf", {"app/take/gltf"}},
    {"toml++/", {"scenes/read/toml.cpp"}},
    {"pugixml", {"scenes/models/xml.cpp"}},
    {"muParser", {"scenes/read/expression.cpp"}},
    {"cairo", {"app/figure/vector_page.cpp"}},
    {"CLI/", {"app/"}},
    {"nlohmann/", {"app/"}},
    {"bt", {"app/peers/bullet"}},
    {"Bullet", {"app/peers/bullet"}},
    {"ode/", {"app/peers/ode"}},
    {"mujoco/", {"app/peers/mujoco"}}};

TEST(Packages, StayBehindTheFilesThatMayKnowThem) {
  for (const char* folder : {"physics", "render", "scenes", "app"}) {
    for (const Include& include : findIncludes(folder)) {
      for (const auto& [package, homes] : kPackages) {
        if (!startsWith(include.what, package)) continue;
        const auto holds = [&](const std::string& home) {
          return startsWith(include.file.string(), home);
        };
        EXPECT_TRUE(std::any_of(homes.begin(), homes.end(), holds))
            << include.file << " includes " << include.what;
      }
    }
  }
}

TEST(Packages, CollisionAndSceneLibrariesAreInOneSourceFileEach) {
  for (const auto& [package, folder] :
       {std::pair("fcl/", "physics"), std::pair("toml++/", "scenes"), std::pair("stb_", "render"),
        std::pair("imgui", "render")}) {
    std::set<std::string> files;
    for (const Include& include : findIncludes(folder)) {
      if (startsWith(include.what, package)) files.insert(include.file.string());
    }
    EXPECT_LE(files.size(), 1u) << package << " in " << testing::PrintToString(files);
    for (const std::string& file : files) EXPECT_TRUE(file.ends_with(".cpp")) << file;
  }
}

TEST(Clocks, AreReadByTheProgramOnly) {
  for (const char* folder : {"physics", "scenes", "render"}) {
    for (const Include& include : findIncludes(folder)) {
      EXPECT_NE(include.what, "chrono") << include.file;
      EXPECT_NE(include.what, "ctime") << include.file;
    }
  }
}

}  // namespace
}  // namespace tests
