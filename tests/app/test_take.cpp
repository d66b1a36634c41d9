// Files of a run that others open: a page in a browser, glTF in Blender.
#include <tiny_gltf.h>

#include <cmath>

#include "program.h"
#include "render/png.h"

namespace tests {
namespace {

bool isThere(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

double numberIn(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

// Position of a body in a frame, from the table that the same command wrote.
std::array<double, 3> placeOf(const std::filesystem::path& table, const std::string& body,
                              int frame) {
  for (const std::string& line : lines(readBytes(table))) {
    const std::vector<std::string> row = cells(line);
    if (row[0] != std::to_string(frame) || row[2] != body) continue;
    return {std::stod(row[3]), std::stod(row[4]), std::stod(row[5])};
  }
  ADD_FAILURE() << "no row of " << body << " in frame " << frame;
  return {};
}

class Take : public Program {
 protected:
  // Opens a page without a screen, with a software renderer; `more` are options and the page.
  std::string browse(const std::string& more) const {
    const std::string command =
        "cd '" + folder.string() +
        "' && timeout 120 chromium --headless=new --no-sandbox --use-gl=angle "
        "--use-angle=swiftshader --enable-unsafe-swiftshader --window-size=640,400 "
        "--hide-scrollbars --enable-logging=stderr --v=0 --virtual-time-budget=3000 "
        "--user-data-dir=browser " +
        more + " >browser.out 2>browser.err";
    EXPECT_EQ(std::system(command.c_str()), 0) << readBytes(folder / "browser.err");
    EXPECT_EQ(readBytes(folder / "browser.err").find("CONSOLE"), std::string::npos)
        << readBytes(folder / "browser.err");
    return readBytes(folder / "browser.out");
  }

  // What the page's body says of itself: data-NAME="...".
  static std::string toldOf(const std::string& page, const std::string& name) {
    const std::string key = "data-" + name + "=\"";
    const std::size_t at = page.find(key);
    if (at == std::string::npos) return "";
    const std::size_t from = at + key.size();
    return page.substr(from, page.find('"', from) - from);
  }
};

TEST_F(Take, APlayerIsOneFileThatAsksNothingOfANetwork) {
  ASSERT_EQ(run("simulate drop.toml --player p.html").code, 0);
  const std::string page = readBytes(folder / "p.html");
  EXPECT_EQ(page.find("http:"), std::string::npos);
  EXPECT_EQ(page.find("https:"), std::string::npos);
  EXPECT_EQ(page.find(" src="), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_EQ(page.find("import "), std::string::npos);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    EXPECT_NE(entry.path().extension(), ".npz") << entry.path();
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
}

TEST_F(Take, APlayerIsTheSameFromAMotionAndOnTwoThreads) {
  ASSERT_EQ(run("simulate drop.toml --player a.html --gltf a.glb --motion m.npz").code, 0);
  ASSERT_EQ(run("simulate drop.toml --threads 2 --player b.html --gltf b.glb").code, 0);
  const Outcome drawn =
      run("render --from m.npz --size 64x36 --quality draft -o r --player c.html --gltf c.glb");
  ASSERT_EQ(drawn.code, 0) << drawn.errors;
  ASSERT_EQ(run("render drop.toml --size 64x36 --quality draft -o s").code, 0);
  ASSERT_EQ(run("render drop.toml --size 64x36 --quality draft -o s --player d.html").code, 0);
  const std::string page = readBytes(folder / "a.html"), model = readBytes(folder / "a.glb");
  EXPECT_EQ(page, readBytes(folder / "b.html"));
  EXPECT_EQ(page, readBytes(folder / "c.html"));
  EXPECT_EQ(page, readBytes(folder / "d.html")) << "of a render that was whole before";
  EXPECT_EQ(model, readBytes(folder / "b.glb"));
  EXPECT_EQ(model, readBytes(folder / "c.glb"));
}

TEST_F(Take, ATitleCannotLeaveItsPlace) {
  std::string scene = readBytes(folder / "drop.toml");
  const std::string hostile = "</script><b>&\\\"{{take}}";
  scene = "title = \"" + hostile + "\"\ndescription = \"</script><i>\"\n" +
          scene.substr(scene.find("duration"));
  writeText(folder / "hostile.toml", scene);
  const Outcome outcome = run("simulate hostile.toml --player p.html");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::string page = readBytes(folder / "p.html");
  EXPECT_EQ(page.find("<b>&"), std::string::npos);
  EXPECT_EQ(page.find("<i>"), std::string::npos);
  EXPECT_NE(page.find("&lt;/script&gt;&lt;b&gt;&amp;"), std::string::npos);
  if (!isThere("chromium")) GTEST_SKIP() << "no chromium to open it with";
  EXPECT_EQ(toldOf(browse("--dump-dom p.html"), "state"), "ready");
}

TEST_F(Take, AnotherEndingIsRefusedBeforeTheFirstStep) {
  for (const char* option : {"--player p.png", "--gltf p.obj", "--player p.glb"}) {
    const Outcome outcome = run(std::string("simulate drop.toml ") + option);
    EXPECT_EQ(outcome.code, 2) << option;
    EXPECT_NE(outcome.errors.find("expected a name that ends in"), std::string::npos)
        << outcome.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

TEST_F(Take, SharesOfAFilmHaveNone) {
  const Outcome outcome = run("render drop.toml --jobs 2 --player p.html");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("dbd simulate"), std::string::npos) << outcome.errors;
}

TEST_F(Take, WhatNoBrowserOpensIsRefusedBeforeTheFirstStep) {
  const Outcome outcome =
      run("simulate pyramid --set duration=2000 --player long.html --progress none");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.errors.find("long.html"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("fewer frames"), std::string::npos) << outcome.errors;
}

TEST_F(Take, APlayerDrawsAndPlaysInABrowserAndHasTheMotion) {
  if (!isThere("chromium")) GTEST_SKIP() << "no chromium to open it with";
  ASSERT_EQ(run("simulate drop.toml --player p.html --trajectory t.csv").code, 0);
  std::string page = readBytes(folder / "p.html");
  // A browser without a screen gives few frames in its virtual seconds, by chance three: its timers
  // call for them instead.
  page.replace(page.find("<body"), 0,
               "<script>window.requestAnimationFrame = (next) => "
               "setTimeout(() => next(performance.now()), 16);</script>");
  const std::string asking =
      "<script>setTimeout(() => { const take = window.player.take, p = "
      "take.names.indexOf('ball');"
      "document.body.dataset.height = take.poses.one(8 * p + 1, 15); }, 1500)</script></body>";
  page.replace(page.rfind("</body>"), 7, asking);
  writeText(folder / "asked.html", page);
  const std::string told = browse("--dump-dom 'asked.html'");
  EXPECT_EQ(toldOf(told, "state"), "ready");
  EXPECT_GT(numberIn(toldOf(told, "drawn")), 20);
  // 16 bits over the 0.5 m that it falls: half a step is 4e-6 m.
  EXPECT_NEAR(numberIn(toldOf(told, "height")), placeOf(folder / "t.csv", "ball", 15)[1], 4e-6);
}

TEST_F(Take, APlayerShowsAnotherPictureAtAnotherTime) {
  if (!isThere("chromium")) GTEST_SKIP() << "no chromium to open it with";
  ASSERT_EQ(run("simulate drop.toml --player p.html").code, 0);
  const auto shoot = [&](const std::string& hash) {
    const std::string url = "'file://" + (folder / "p.html").string() + "#play=0&" + hash + "'";
    browse("--screenshot=shot.png " + url);
    return render::readPng(folder / "shot.png");
  };
  const auto differing = [](const render::Image& a, const render::Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
      count += std::abs(a.rgb[i] - b.rgb[i]) > 20 ? 1 : 0;
    }
    return count;
  };
  const render::Image start = shoot("t=0"), later = shoot("t=0.3"),
                      contacts = shoot("t=0.3&show=wire");
  ASSERT_EQ(start.rgb.size(), later.rgb.size());
  EXPECT_GT(differing(start, later), 500);
  EXPECT_GT(differing(later, contacts), 500);
}

// A ball that flies, followed by the camera, with a label for a part of the time, in slow motion.
constexpr const char* kFollowed = R"(title = "Followed"
duration = 0.5
[[body]]
name = "ball"
shape = { sphere = { radius = 0.1 } }
position = [0, 1, 0]
velocity = [4, 0, 0]
[camera]
follow = "ball"
[[label]]
text = "*v* = 4 m/s"
body = "ball"
to = 0.25
[film]
speed = 0.3
fps = 15
)";

TEST_F(Take, APlayerHasTheFilmsFramesItsSpeedAndItsLabels) {
  writeText(folder / "followed.toml", kFollowed);
  const Outcome outcome = run("simulate followed.toml --player p.html --set film.shutter=180");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const std::string page = readBytes(folder / "p.html");
  EXPECT_NE(page.find("\"fps\":50,\"frames\":26,\"speed\":0.3,"), std::string::npos);
  EXPECT_NE(page.find("{\"words\":\"v\",\"level\":0,\"slanted\":true}"), std::string::npos);
}

TEST_F(Take, APlayersCameraGoesAlongAndItsLabelsAreThereWhileTheyAreToBeSeen) {
  if (!isThere("chromium")) GTEST_SKIP() << "no chromium to open it with";
  writeText(folder / "followed.toml", kFollowed);
  ASSERT_EQ(run("simulate followed.toml --player p.html").code, 0);
  std::string page = readBytes(folder / "p.html");
  const std::string asking =
      "<script>setTimeout(() => { const p = window.player, told = document.body.dataset;"
      "const words = []; p.words.write = (text) => words.push(text);"
      "p.goTo(0); p.draw(); const start = p.view.target[0], focus = p.view.focus[0];"
      "p.view.turn(0.3, 0); p.goTo(25); p.draw();"
      "told.moved = p.view.target[0] - start; told.shadows = p.view.focus[0] - focus;"
      "told.words = words.join(''); told.speed = document.getElementById('speed').value;"
      "}, 1500)</script></body>";
  page.replace(page.rfind("</body>"), 7, asking);
  writeText(folder / "asked.html", page);
  const std::string told = browse("--dump-dom asked.html");
  EXPECT_EQ(toldOf(told, "state"), "ready");
  EXPECT_NEAR(numberIn(toldOf(told, "moved")), 2, 1e-3) << "4 m/s for half a second";
  EXPECT_NEAR(numberIn(toldOf(told, "shadows")), 2, 1e-3) << "they are around what is followed";
  EXPECT_EQ(toldOf(told, "words"), "v = 4 m/s") << "at the start and not at the end";
  EXPECT_EQ(toldOf(told, "speed"), "0.3");
}

TEST_F(Take, AGltfIsReadByItsLibraryAndHasTheMotion) {
  const Outcome outcome =
      run("simulate wrecking_ball --set duration=1 --gltf w.glb --trajectory t.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string errors, warnings;
  ASSERT_TRUE(reader.LoadBinaryFromFile(&model, &errors, &warnings, (folder / "w.glb").string()))
      << errors;
  EXPECT_EQ(errors + warnings, "");
  ASSERT_EQ(model.animations.size(), 1u);
  const tinygltf::Animation& animation = model.animations[0];
  int tracks = 0;
  for (const tinygltf::AnimationChannel& channel : animation.channels) {
    const std::string& name = model.nodes[static_cast<std::size_t>(channel.target_node)].name;
    if (channel.target_path != "translation" || name != "chain.10") continue;
    ++tracks;
    const auto& sampler = animation.samplers[static_cast<std::size_t>(channel.sampler)];
    const auto& output = model.accessors[static_cast<std::size_t>(sampler.output)];
    ASSERT_EQ(output.count, 61u);
    const auto& view = model.bufferViews[static_cast<std::size_t>(output.bufferView)];
    const auto* rows = reinterpret_cast<const float*>(model.buffers[0].data.data() +
                                                      view.byteOffset + output.byteOffset);
    const std::array<double, 3> place = placeOf(folder / "t.csv", name, 45);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_FLOAT_EQ(rows[3 * 45 + k], static_cast<float>(place[k]));
    const auto& times = model.accessors[static_cast<std::size_t>(sampler.input)];
    EXPECT_FLOAT_EQ(static_cast<float>(times.maxValues.at(0)), 1.0f);
  }
  EXPECT_EQ(tracks, 1);
}

TEST_F(Take, AGltfWithItsNumbersInsideIsTheSameModel) {
  ASSERT_EQ(run("simulate drop.toml --gltf d.gltf").code, 0);
  tinygltf::Model model;
  tinygltf::TinyGLTF reader;
  std::string errors, warnings;
  ASSERT_TRUE(reader.LoadASCIIFromFile(&model, &errors, &warnings, (folder / "d.gltf").string()));
  EXPECT_EQ(errors + warnings, "");
  EXPECT_EQ(model.asset.version, "2.0");
}

// Debian's importer asks NumPy for `bool`, which its NumPy has no longer: the script gives it back.
constexpr const char* kImport = R"(
import bpy, numpy, sys
numpy.bool = bool
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.context.scene.render.fps = 60
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
scene = bpy.context.scene
for name, frame in (('chain.10', 0), ('chain.10', 45), ('wall.42', 45)):
    if name in bpy.data.objects:
        scene.frame_set(frame)
        print('AT', name, frame, *bpy.data.objects[name].matrix_world.translation)
for thing in bpy.data.objects:
    if thing.type == 'MESH' and thing.data.shape_keys:
        for frame in (0, 10):
            scene.frame_set(frame)
            print('KEYS', frame, [k.name for k in thing.data.shape_keys.key_blocks if k.value > 0.5])
)";

class Blender : public Take {
 protected:
  std::string import(const std::string& file) const {
    writeText(folder / "import.py", kImport);
    const std::string command = "cd '" + folder.string() +
                                "' && timeout 250 blender -b --factory-startup --python-exit-code "
                                "9 --python import.py -- " +
                                file + " >blender.out 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << readBytes(folder / "blender.out");
    return readBytes(folder / "blender.out");
  }
};

TEST_F(Blender, HasTheBodiesWhereTheyWere) {
  if (!isThere("blender")) GTEST_SKIP() << "no blender to import it with";
  ASSERT_EQ(run("simulate wrecking_ball --set duration=1 --gltf w.glb --trajectory t.csv").code, 0);
  int found = 0;
  for (const std::string& line : lines(import("w.glb"))) {
    char name[32];
    int frame = 0;
    std::array<double, 3> at{};
    if (std::sscanf(line.c_str(), "AT %31s %d %lf %lf %lf", name, &frame, &at[0], &at[1], &at[2]) !=
        5)
      continue;
    ++found;
    const std::array<double, 3> place = placeOf(folder / "t.csv", name, frame);
    EXPECT_NEAR(at[0], place[0], 1e-5) << line;  // z is up there
    EXPECT_NEAR(at[1], -place[2], 1e-5) << line;
    EXPECT_NEAR(at[2], place[1], 1e-5) << line;
  }
  EXPECT_EQ(found, 3);
}

TEST_F(Blender, HasAClothAsAShapeForEachFrame) {
  if (!isThere("blender")) GTEST_SKIP() << "no blender to import it with";
  ASSERT_EQ(run("simulate cloth_hang --set duration=0.25 --gltf c.glb").code, 0);
  const std::string told = import("c.glb");
  EXPECT_NE(told.find("KEYS 0 []"), std::string::npos) << told;
  EXPECT_NE(told.find("KEYS 10 ['target_9']"), std::string::npos) << told;
}

}  // namespace
}  // namespace tests
