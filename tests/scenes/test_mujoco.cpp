// MJCF as MuJoCo itself reads it: the same bodies, poses, masses, centres and inertias. Built where
// MuJoCo is found.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <fstream>
#include <iterator>

#include "scenes/models/mjcf.h"

namespace scenes {
namespace {

using physics::Mat3;
using physics::Pose;
using physics::Quat;
using physics::Vec3;

struct MujocoModel {
  explicit MujocoModel(const std::string& path) {
    char error[1000] = "";
    model = mj_loadXML(path.c_str(), nullptr, error, sizeof error);
    EXPECT_NE(model, nullptr) << error;
  }
  ~MujocoModel() { mj_deleteModel(model); }
  mjModel* model = nullptr;
};

Vec3 vectorAt(const mjtNum* numbers, int k) {
  return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
}

Quat turnAt(const mjtNum* numbers, int k) {
  return {numbers[4 * k], numbers[4 * k + 1], numbers[4 * k + 2], numbers[4 * k + 3]};
}

Model ours(const std::string& path) {
  std::ifstream file(path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const Context context{path, nullptr, nullptr};
  ModelSurvey survey(context);
  return readMjcf(parseXml(text, path), path, survey);
}

void expectSame(const ModelLink& link, const mjModel& m, int k, double most) {
  const Quat turn = turnAt(m.body_quat, k);
  EXPECT_LT((link.pose.x - vectorAt(m.body_pos, k)).norm(), 1e-9) << link.name;
  EXPECT_LT(link.pose.q.angularDistance(turn), 1e-7) << link.name;
  const ModelInertial own = inertialOf(link);
  const Mat3 axes = turnAt(m.body_iquat, k).toRotationMatrix();
  const Mat3 inertia = axes * vectorAt(m.body_inertia, k).asDiagonal() * axes.transpose();
  EXPECT_NEAR(own.mass, m.body_mass[k], most * m.body_mass[k]) << link.name;
  EXPECT_LT((own.centre - vectorAt(m.body_ipos, k)).norm(), most) << link.name;
  EXPECT_LT((own.inertia - inertia).norm(), most * inertia.norm()) << link.name;
}

TEST(Mujoco, ReadsTheSameBodies) {
  const std::string path = DBD_TEST_FOLDER "/models/plain.xml";
  const MujocoModel theirs(path);
  ASSERT_NE(theirs.model, nullptr);
  const Model own = ours(path);
  ASSERT_EQ(static_cast<int>(own.links.size()), theirs.model->nbody);
  for (int k = 1; k < theirs.model->nbody; ++k) {
    const ModelLink& link = own.links[static_cast<std::size_t>(k)];
    ASSERT_EQ(link.name, mj_id2name(theirs.model, mjOBJ_BODY, k));
    // MuJoCo keeps meshes in single precision; of an ellipsoid we have a hull of 162 points.
    expectSame(link, *theirs.model, k, 1e-6);
  }
}

}  // namespace
}  // namespace scenes
