// `dbd convert`, and models wherever a scene is asked for.
#include "program.h"

namespace tests {
namespace {

constexpr const char* kModel =
    "<mujoco model='swing'>\n"
    "  <option timestep='0.001'/>\n"
    "  <worldbody>\n"
    "    <geom type='plane' size='1 1 1' pos='0 0 -1'/>\n"
    "    <body name='bar' pos='0 0 0.5'>\n"
    "      <joint name='pivot' axis='0 1 0' damping='0.1'/>\n"
    "      <geom type='capsule' size='0.05' fromto='0 0 0 0.6 0 0'/>\n"
    "    </body>\n"
    "  </worldbody>\n"
    "  <actuator><motor name='push' joint='pivot'/></actuator>\n"
    "</mujoco>\n";

class Convert : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    writeText(folder / "swing.xml", kModel);
  }
};

TEST_F(Convert, WritesASceneThatMovesAsTheModelDoes) {
  const Outcome convert = run("convert swing.xml -o swing.toml");
  ASSERT_EQ(convert.code, 0) << convert.errors;
  EXPECT_EQ(convert.errors, "dbd: warning: swing.xml:2: not read: timestep of <option>\n");
  const std::string more =
      " --set duration=1 --set motor_torque.push.stall_torque=2 --hash --quiet";
  const Outcome model = run("simulate swing.xml -o a" + more);
  const Outcome scene = run("simulate swing.toml -o b" + more);
  ASSERT_EQ(model.code, 0) << model.errors;
  EXPECT_EQ(model.output, scene.output);
  EXPECT_EQ(run("convert swing.xml").output, readBytes(folder / "swing.toml"));
}

TEST_F(Convert, DrawsAModel) {
  ASSERT_EQ(run("render swing.xml --frames 0:20:10 --size 96x64 --quality draft --quiet").code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "swing" / "frames" / "00010.png"));
}

TEST_F(Convert, AModelStandsOnTheGroundOfASceneThatIncludesIt) {
  writeText(folder / "scene.toml",
            "include = \"swing.xml\"\ntitle = \"Mine\"\nduration = 0.1\n"
            "[[body]]\nname = \"wall\"\nshape = { box = { size = [1, 1, 1] } }\nfixed = true\n"
            "position = [5, 0, 0]\n[[expect]]\nmetric = \"finite\"\n");
  const Outcome check = run("check scene.toml --progress none");
  EXPECT_EQ(check.code, 0) << check.errors;
  EXPECT_NE(check.errors.find("swing.xml:2: not read"), std::string::npos) << check.errors;
}

TEST_F(Convert, RefusesWhatIsNoModel) {
  EXPECT_EQ(run("convert drop.toml").errors,
            "dbd: convert: expected a model, .xml, .mjcf or .urdf, got drop.toml\n");
  EXPECT_EQ(run("convert nothing.xml").code, 2);
  writeText(folder / "bad.xml", "<mujoco>\n<worldbody><geom type='ball'/></worldbody></mujoco>\n");
  const Outcome bad = run("convert bad.xml");
  EXPECT_EQ(bad.code, 2);
  EXPECT_EQ(bad.errors.rfind("dbd: bad.xml:2:13: <geom>: type: unknown 'ball'", 0), 0u)
      << bad.errors;
}

}  // namespace
}  // namespace tests
