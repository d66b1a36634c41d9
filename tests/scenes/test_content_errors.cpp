// What is wrong with bodies and constraints is reported at its place in the file.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

std::string bodyError(const std::string& line) { return errorOf(ball("a") + line); }

TEST(SceneBody, RefusesAMassOfZero) {
  EXPECT_EQ(bodyError("mass = 0\n"), "test.toml:4:8: body.mass: expected a number > 0, got 0");
}

TEST(SceneBody, RefusesANegativeMass) {
  EXPECT_EQ(bodyError("mass = -2\n"), "test.toml:4:8: body.mass: expected a number > 0, got -2");
}

TEST(SceneBody, RefusesAMassThatIsNotANumber) {
  EXPECT_EQ(bodyError("mass = nan\n"),
            "test.toml:4:8: body.mass: expected a finite number > 0, got nan");
}

TEST(SceneBody, RefusesAMassInWords) {
  EXPECT_EQ(bodyError("mass = \"two\"\n"),
            "test.toml:4:8: body.mass: expected a number > 0, got 'two'");
}

TEST(SceneBody, RefusesMassAndDensityTogether) {
  EXPECT_EQ(bodyError("mass = 1\ndensity = 1\n"),
            "test.toml:5:11: body.density: expected 'mass' or 'density', not both");
}

TEST(SceneBody, RefusesInertiaThatBreaksTheTriangleRule) {
  EXPECT_EQ(bodyError("inertia = [1, 1, 2.5]\n"),
            "test.toml:4:11: body.inertia: expected moments of which none exceeds the sum of the "
            "other two, got [1, 1, 2.5]");
}

TEST(SceneBody, RefusesAQuaternionOfZero) {
  EXPECT_EQ(bodyError("quaternion = [0, 0, 0, 0]\n"),
            "test.toml:4:14: body.quaternion: expected a quaternion that is not zero, got an array "
            "of 4");
}

TEST(SceneBody, RefusesANameThatIsTaken) {
  EXPECT_EQ(errorOf(ball("a") + ball("a")),
            "test.toml:5:8: body.name: expected a new name, 'a' is a body already");
}

TEST(SceneBody, RefusesAnUnknownShape) {
  EXPECT_EQ(errorOf("[[body]]\nshape = { spere = { radius = 1 } }\n"),
            "test.toml:2:11: body.shape: unknown shape 'spere'; did you mean 'sphere'?");
  EXPECT_EQ(errorOf("[[body]]\nshape = { banana = {} }\n"),
            "test.toml:2:11: body.shape: unknown shape 'banana'; expected point, box, sphere, "
            "capsule, cylinder, convex, plane, triangles or heights");
}

TEST(SceneBody, RefusesARadiusOfZero) {
  EXPECT_EQ(errorOf("[[body]]\nshape = { sphere = { radius = 0 } }\n"),
            "test.toml:2:31: body.shape.sphere.radius: expected a number > 0 [m], got 0");
}

TEST(SceneBody, RefusesAMeshThatIsNotThere) {
  EXPECT_EQ(errorOf("[[body]]\nshape = { convex = { mesh = \"none.obj\" } }\n"),
            "test.toml:2:29: body.shape.convex.mesh: no mesh 'none.obj' beside the scene or in "
            "assets/meshes");
}

TEST(SceneBody, RefusesAnEmptyMesh) {
  const std::string text = "[[body]]\nshape = { convex = { mesh = \"empty.obj\" } }\n";
  const std::string path = std::string(DBD_TEST_FOLDER) + "/test.toml";
  try {
    parseScene(text, path);
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), path +
                                             ":2:29: body.shape.convex.mesh: expected a mesh with "
                                             "vertices, got the empty 'empty.obj'");
  }
}

TEST(SceneBody, RefusesPointsInOnePlane) {
  EXPECT_TRUE(errorOf("[[body]]\nshape = { convex = { points = "
                      "[[0,0,0],[1,0,0],[0,1,0],[1,1,0]] } }\n")
                  .starts_with("test.toml:2:31: body.shape.convex.points: "));
}

TEST(SceneBody, RefusesAPlaneThatMoves) {
  EXPECT_EQ(errorOf("[[body]]\nshape = { plane = {} }\nfixed = false\n"),
            "test.toml:3:9: body.fixed: expected true: a plane does not move");
}

TEST(SceneConstraint, NamesTheNearestBodyForAnUnknownOne) {
  EXPECT_EQ(errorOf(ball("plank") + "[[ball_socket]]\nbodies = [\"world\", \"plonk\"]\n"),
            "test.toml:5:20: ball_socket: no body 'plonk'; did you mean 'plank'?");
}

TEST(SceneConstraint, RefusesAJointOfABodyToItself) {
  EXPECT_EQ(errorOf(ball("a") + "[[hinge]]\nbodies = [\"a\", \"a\"]\nat = [0,0,0]\n"),
            "test.toml:5:10: hinge.bodies: expected two different bodies, got 'a' twice");
}

TEST(SceneConstraint, WantsABodyThatCanMove) {
  EXPECT_EQ(errorOf(ball("a") + "fixed = true\n[[distance]]\nbodies = [\"world\", \"a\"]\n"),
            "test.toml:6:10: distance.bodies: expected at least one body that can move");
}

TEST(SceneConstraint, RefusesANameThatAnotherOfItsKindHas) {
  const std::string joint = "bodies = [\"world\", \"a\"]\nat = [0, 0, 0]\nname = \"hook\"\n";
  EXPECT_EQ(errorOf(ball("a") + "[[ball_socket]]\n" + joint + "[[weld]]\n" + joint), "no error");
  EXPECT_EQ(
      errorOf(ball("a") + "[[ball_socket]]\n" + joint + "[[ball_socket]]\n" + joint),
      "test.toml:11:8: ball_socket.name: expected a new name, 'hook' is a ball_socket already");
}

TEST(SceneConstraint, WantsAPlaceForABallSocket) {
  EXPECT_EQ(errorOf(ball("a") + "[[ball_socket]]\nbodies = [\"world\", \"a\"]\n"),
            "test.toml:4:1: ball_socket: expected 'at' or 'anchors'");
}

TEST(SceneConstraint, RefusesLimitsInTheWrongOrder) {
  EXPECT_EQ(errorOf(ball("a") + "[[twist_limit]]\nbodies = [\"world\", \"a\"]\naxis = [1,0,0]\n"
                                "degrees = [30, -30]\n"),
            "test.toml:7:11: twist_limit.degrees: expected [low, high] with low <= high, got [30, "
            "-30]");
}

TEST(SceneConstraint, RefusesAnAxisOfZero) {
  EXPECT_EQ(errorOf(ball("a") + "[[axle]]\nbodies = [\"world\", \"a\"]\naxis = [0, 0, 0]\n"),
            "test.toml:6:8: axle.axis: expected a direction that is not zero, got an array of 3");
}

TEST(SceneConstraint, RefusesANegativeStiffness) {
  EXPECT_EQ(errorOf(ball("a") + "[[spring]]\nbodies = [\"world\", \"a\"]\nstiffness = -1\n"),
            "test.toml:6:13: spring.stiffness: expected a number >= 0 [N/m], got -1");
}

TEST(SceneConstraint, TakesATorqueWithoutALimit) {
  EXPECT_EQ(errorOf(ball("a") + "[[drive]]\nbodies = [\"world\", \"a\"]\nstiffness = 1\n"
                                "max_torque = inf\n"),
            "no error");
}

TEST(Scene, NamesTheNearestSceneForAnUnknownOne) {
  try {
    readScene("pyramyd");
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "no scene 'pyramyd' in the library; did you mean 'pyramid'?");
  }
}

TEST(SceneExpect, RefusesBoundsThatNothingCanKeep) {
  EXPECT_EQ(errorOf(ball("a") + "[[expect]]\nmetric = \"overlap\"\nat_least = 2\nat_most = 1\n"),
            "test.toml:7:11: expect.at_most: expected a number >= at_least = 2, or nothing can be "
            "both");
}

TEST(SceneGolden, RefusesAHashThatIsNone) {
  for (const char* hash : {"0123456789abcde", "0123456789abcdefa", "0123456789abcdeg"}) {
    const std::string error =
        errorOf(ball("a") + "[golden]\nframes = [0]\nstate_hash = \"" + hash + "\"\n");
    EXPECT_NE(error.find("golden.state_hash: expected 16 hex digits"), std::string::npos) << error;
  }
}

TEST(SceneSimulation, TellsWhatTheMethodDoesNotLookAt) {
  const auto toldOf = [](const std::string& words) {
    const Scene scene = sceneOf(ball("a") + "[simulation]\n" + words);
    return scene.told.empty() ? std::string() : scene.told.back();
  };
  EXPECT_EQ(toldOf("substeps = 4\naccuracy = 1e-2\nregularisation = 1e-3\n"), "");
  EXPECT_EQ(toldOf("iterations = 8\n"),
            "simulation: iterations changes nothing: method = \"small_steps\" does not look at it");
  EXPECT_EQ(toldOf("tolerance = 1e-6\nrelaxation = 1.2\n"),
            "simulation: tolerance, relaxation change nothing: method = \"small_steps\" does not "
            "look at them");
  EXPECT_EQ(toldOf("stepping = \"bdf2\"\niterations = 8\n"), "");
  EXPECT_EQ(toldOf("stepping = \"bdf2\"\naccuracy = 1e-3\n"),
            "simulation: accuracy changes nothing: stepping = \"bdf2\" does not look at it");
  EXPECT_EQ(toldOf("method = \"xpbd\"\naccuracy = 1e-3\n"),
            "simulation: accuracy changes nothing: method = \"xpbd\" does not look at it");
}

}  // namespace
}  // namespace scenes
