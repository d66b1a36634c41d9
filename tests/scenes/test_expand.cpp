// include, [parameters], "= expressions" and [[repeat]].
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenes/read/expression.h"
#include "scenes/simulation.h"
#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

namespace fs = std::filesystem;

double valueOf(const std::string& expression) { return Expressions().evaluate(expression); }

std::string mistakeIn(const std::string& expression) {
  try {
    Expressions().evaluate(expression);
  } catch (const ExpressionError& error) {
    return std::to_string(error.position) + ": " + error.what();
  }
  return "no error";
}

TEST(Expression, ComputesAsOneWrites) {
  EXPECT_EQ(valueOf("2 + 3 * 4 ^ 2"), 50);
  EXPECT_EQ(valueOf("-2 ^ 2"), -4);
  EXPECT_EQ(valueOf("7 % 3"), 1);
  EXPECT_EQ(valueOf("-1 % 3"), 2);  // an index goes round
  EXPECT_EQ(valueOf("1 < 2 && !(3 <= 2) ? 10 : 20"), 10);
  EXPECT_EQ(valueOf("max(1, 5, 3) + min(2, 1) + sum(1, 2, 3)"), 12);
  EXPECT_EQ(valueOf("1e-3 * 1e3"), 1);
  EXPECT_DOUBLE_EQ(valueOf("cos(rad(60)) + atan2(1, 1) / pi"), 0.75);
}

TEST(Expression, RandomFollowsFromItsNumbers) {
  double sum = 0;
  for (int i = 0; i < 1000; ++i) {
    const double x = valueOf("random(" + std::to_string(i) + ", 7)");
    EXPECT_GE(x, 0);
    EXPECT_LT(x, 1);
    sum += x;
  }
  EXPECT_NEAR(sum / 1000, 0.5, 0.03);
  EXPECT_EQ(valueOf("random(3)"), valueOf("random(1 + 2)"));
  EXPECT_NE(valueOf("random(3, 4)"), valueOf("random(4, 3)"));
}

TEST(Expression, TellsWhatIsWrongAndWhere) {
  EXPECT_EQ(mistakeIn("1 / 0"), "-1: expected a finite number, got inf");
  EXPECT_EQ(mistakeIn("1 % 0"), "-1: expected a finite number, got nan");
  EXPECT_EQ(mistakeIn("1 + bb"), "4: unknown name 'bb'");
  EXPECT_EQ(mistakeIn("1 + sine(2)"), "8: no function or list 'sine'; did you mean 'sin'?");
  EXPECT_EQ(mistakeIn("1 +"), "3: expected an expression");
  EXPECT_EQ(mistakeIn(""), "0: expected an expression");
  EXPECT_EQ(mistakeIn(std::string(1001, '1')), "-1: expected at most 1000 letters, got 1001");
}

TEST(Expression, ANameIsForgotten) {
  Expressions known;
  known.define("i", 3);
  EXPECT_EQ(known.evaluate("2 * i"), 6);
  known.define("i", 4);
  EXPECT_EQ(known.evaluate("2 * i"), 8);
  known.forget("i");
  EXPECT_THROW(known.evaluate("2 * i"), ExpressionError);
  known.define("i", std::vector<double>{5, 6});
  EXPECT_EQ(known.evaluate("i(1)"), 6);
  EXPECT_THROW(known.evaluate("i"), ExpressionError);
  EXPECT_THROW(known.evaluate("i(2)"), ExpressionError);
}

constexpr const char* kRow =
    "title = \"{n} balls\"\n"
    "[parameters]\nm = \"= 2 * n\"\nn = 3\nmasses = [1, \"= n\", 5]\n"
    "[[repeat]]\ncount = \"= n\"\n"
    "[[repeat.body]]\nname = \"b.{i}\"\nshape = { sphere = { radius = 0.1 } }\n"
    "mass = \"= masses(i)\"\nposition = [\"= i\", 0, \"= m\"]\n";

TEST(Expand, RepeatsWithParameters) {
  const Scene scene = sceneOf(kRow);
  EXPECT_EQ(scene.title, "3 balls");
  const Simulation simulation(scene);
  ASSERT_EQ(simulation.world().bodyCount(), 4);
  EXPECT_EQ(simulation.world().bodies().mass[2], 3);
  EXPECT_EQ(simulation.world().bodies().pose[3].x, physics::Vec3(2, 0, 6));
}

TEST(Expand, AParameterAndWhatItMakesAreSetFromOutside) {
  const Simulation fewer(sceneOf(kRow, {"parameters.n=2", "body.b.1.mass=7"}));
  ASSERT_EQ(fewer.world().bodyCount(), 3);
  EXPECT_EQ(fewer.world().bodies().mass[2], 7);
  EXPECT_EQ(fewer.world().bodies().pose[1].x, physics::Vec3(0, 0, 4));
  EXPECT_EQ(errorOf(kRow, {"parameters.nn=2"}),
            "--set parameters.nn=2: no parameter 'nn'; did you mean 'n'?");
  EXPECT_EQ(errorOf("", {"parameters.n=2"}), "--set parameters.n=2: the scene has no [parameters]");
}

TEST(Expand, RepeatsWithinARepeat) {
  const Scene scene = sceneOf(
      "[[repeat]]\nindex = \"row\"\ncount = 3\n"
      "[[repeat.repeat]]\ncount = \"= 3 - row\"\n[repeat.repeat.parameters]\nx = \"= i + row / "
      "2\"\n"
      "[[repeat.repeat.body]]\nname = \"{row}_{i}\"\nshape = { sphere = { radius = 0.1 } }\n"
      "mass = 1\nposition = [\"= x\", \"= row\", 0]\n");
  const Simulation simulation(scene);
  ASSERT_EQ(simulation.world().bodyCount(), 7);
  EXPECT_EQ(simulation.world().bodies().pose[6].x, physics::Vec3(1, 2, 0));
}

TEST(Expand, BracesMeanNothingWhereNothingHasAName) {
  EXPECT_EQ(sceneOf("title = \"{a}\"\n").title, "{a}");
  EXPECT_EQ(sceneOf("title = \"{{a}} {b}\"\n[parameters]\nb = 1.5\n").title, "{a} 1.5");
}

TEST(Expand, TellsWhatIsWrongAndWhere) {
  EXPECT_EQ(errorOf("duration = \"= 2 * x\"\n"), "test.toml:1:19: '= 2 * x': unknown name 'x'");
  EXPECT_EQ(errorOf("[parameters]\na = \"= b\"\nb = \"= a\"\n"),
            "test.toml:2:8: '= b': unknown name 'b'");
  EXPECT_EQ(errorOf("[parameters]\nsin = 1\n"),
            "test.toml:2:1: parameters: expected a name of letters, digits and '_' that is no "
            "function's, got 'sin'");
  EXPECT_EQ(errorOf("[parameters]\na = { b = 1 }\n"),
            "test.toml:2:5: parameters.a: expected a number, a list of numbers or a text, got a "
            "table");
  EXPECT_EQ(errorOf("[[repeat]]\ncount = 2\n[repeat.body]\nmass = 1\n"),
            "test.toml:3:9: repeat: expected [[repeat.body]], got a table");
  EXPECT_EQ(errorOf("[[repeat]]\ncount = 2.5\n"),
            "test.toml:2:9: repeat.count: expected an integer in [0, 1000000], got 2.5");
  EXPECT_EQ(errorOf("[parameters]\ni = 1\n[[repeat]]\ncount = 2\n"),
            "test.toml:3:1: repeat: the index 'i' is a name already: say another");
  EXPECT_EQ(errorOf("[[repeat]]\ncount = 2\n[[repeat.bdoy]]\nmass = 1\n"),
            "test.toml:3:10: unknown table 'bdoy'; did you mean 'body'?");
}

class Include : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "parts"); }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string error(const std::string& name) const {
    try {
      readScene((folder_ / name).string());
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder_.string().size() + 1);
    }
    return "no error";
  }
  Scene read(const std::string& name) const { return readScene((folder_ / name).string()); }

  fs::path folder_ =  // of this test alone: others run beside it
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Include, PutsTablesBeforeTheFilesOwnWhichCount) {
  write("parts/one.toml", "duration = 3\n[simulation]\nfps = 30\nseed = 4\n[parameters]\nr = 1\n" +
                              ball("one") + "position = [\"= r\", 0, 0]\n");
  write(
      "scene.toml",
      "include = \"parts/one.toml\"\n[simulation]\nfps = 50\n[parameters]\nr = 2\n" + ball("two"));
  const Scene scene = read("scene.toml");
  EXPECT_EQ(scene.duration, 3);
  EXPECT_EQ(scene.fps, 50);
  EXPECT_EQ(scene.seed, 4);
  const Simulation simulation(scene);
  ASSERT_EQ(simulation.world().bodyCount(), 3);
  EXPECT_EQ(simulation.bodyName(1), "one");
  EXPECT_EQ(simulation.world().bodies().pose[1].x.x(), 2);
}

TEST_F(Include, ErrorsNameTheFileThatTheyAreIn) {
  write("parts/bad.toml", "[[body]]\nname = \"a\"\nmas = 1\nshape = { sphere = { radius = 1 } }\n");
  write("scene.toml", "include = [\"parts/bad.toml\"]\n");
  EXPECT_EQ(error("scene.toml"),
            "parts/bad.toml:3:1: body: unknown key 'mas'; did you mean 'mass'?");
  write("parts/bad.toml",
        "[[expect]]\nmetric = \"height\"\nbody = \"b\"\nat_least = 1\n" + ball("a"));
  EXPECT_EQ(error("scene.toml"), "parts/bad.toml:1:1: expect: no body 'b'");
}

TEST_F(Include, OfItselfOrOfNothingIsRefused) {
  write("a.toml", "include = \"b.toml\"\n");
  write("b.toml", "include = \"a.toml\"\n");
  EXPECT_EQ(error("a.toml"),
            "b.toml:1:11: include: " + (folder_ / "a.toml").string() + " includes itself");
  write("a.toml", "include = \"c.toml\"\n");
  EXPECT_EQ(error("a.toml"),
            "a.toml:1:11: include: no file 'c.toml' (" + (folder_ / "c.toml").string() + ")");
  write("a.toml", "include = 3\n");
  EXPECT_EQ(error("a.toml"), "a.toml:1:11: include: expected a file's name, got 3");
}

}  // namespace
}  // namespace scenes
