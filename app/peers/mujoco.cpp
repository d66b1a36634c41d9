// MuJoCo: joint coordinates, contacts as a convex optimisation, all at its defaults.
#include <mujoco/mujoco.h>

#include <cstring>
#include <stdexcept>

#include "app/peers/engines.h"
#include "app/peers/mujoco_model.h"

namespace app {

namespace {

using physics::BodyId;
using physics::Quat;
using physics::Vec3;
using Kind = PeerJoint::Kind;

void giveUp(const char* text) { throw std::runtime_error(std::string("MuJoCo gives up: ") + text); }
void keepQuiet(const char*) {}  // mjData counts them

struct Freeing {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

// Reads the model from memory.
mjModel* readModel(const std::string& words) {
  constexpr const char* kFile = "world.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), kFile, static_cast<int>(words.size()));
  const int file = mj_findFileVFS(files.get(), kFile);
  std::memcpy(files->filedata[file], words.data(), words.size());
  char error[500] = "";
  mjModel* model = mj_loadXML(kFile, files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) giveUp(error);
  return model;
}

class MujocoPeer : public Peer {
 public:
  MujocoPeer(const physics::World& world, Blueprint plan, const Forest& forest, int iterations)
      : plan_(std::move(plan)) {
    mju_user_error = giveUp;
    mju_user_warning = keepQuiet;
    model_.reset(readModel(mujocoModel(world, plan_, forest)));
    model_->opt.iterations = iterations;
    data_.reset(mj_makeData(model_.get()));
    for (BodyId i = 0; i < world.bodyCount(); ++i) {
      const int id = i == 0 ? 0 : mj_name2id(model_.get(), mjOBJ_BODY, mujocoName(i).c_str());
      ids_.push_back(isMovable(world, i) ? id : -1);
    }
    for (BodyId i = 1; i < world.bodyCount(); ++i) {
      if (ids_[i] >= 0) setVelocity(i);
    }
  }

  void step(double h) override {
    model_->opt.timestep = h;
    applyForces();
    mj_step(model_.get(), data_.get());
    for (const int bad : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      // It would begin anew, as if nothing had been.
      if (data_->warning[bad].number > 0) giveUp("its numbers are not finite or too large");
    }
    for (const int full : {mjWARN_CONTACTFULL, mjWARN_CNSTRFULL}) {
      if (data_->warning[full].number > 0) giveUp("more contacts than there is room for");
    }
  }

  void read(std::span<physics::Pose> poses,
            std::span<physics::Velocity> velocities) const override {
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      poses[i] = plan_.start.pose[i];
      velocities[i] = plan_.start.velocity[i];
      if (ids_[i] < 0) continue;
      const mjtNum *x = data_->xpos + 3 * ids_[i], *q = data_->xquat + 4 * ids_[i];
      mjtNum v[6];
      mj_objectVelocity(model_.get(), data_.get(), mjOBJ_XBODY, ids_[i], v, 0);
      poses[i] = {Vec3(x[0], x[1], x[2]), Quat(q[0], q[1], q[2], q[3])};
      velocities[i] = {Vec3(v[3], v[4], v[5]), Vec3(v[0], v[1], v[2])};
    }
  }

  std::int64_t warnings() const override {
    std::int64_t sum = 0;
    for (const mjWarningStat& warning : data_->warning) sum += warning.number;
    return sum;
  }

 private:
  // Of the joint to the parent: what the body does beyond it. A free body turns about its own axes.
  void setVelocity(BodyId i) {
    const int body = ids_[i], joint = model_->body_jntadr[body];
    const physics::Velocity& own = plan_.start.velocity[i];
    const BodyId parent = parentOf(body);
    const Vec3 outer = parent < 0 ? Vec3(0, 0, 0) : plan_.start.velocity[parent].w;
    const Vec3 turn = plan_.start.pose[i].q.conjugate() * (own.w - outer);
    mjtNum* v = data_->qvel + model_->jnt_dofadr[joint];
    const mjtNum* n = model_->jnt_axis + 3 * joint;
    const Vec3 axis(n[0], n[1], n[2]);
    const int type = model_->jnt_type[joint];
    if (type == mjJNT_HINGE) {
      v[0] = axis.dot(turn);
    } else if (type == mjJNT_SLIDE) {
      v[0] = axis.dot(plan_.start.pose[i].q.conjugate() * (own.v - carried(i, parent)));
    } else {
      mjtNum* w = type == mjJNT_FREE ? v + 3 : v;
      for (int k = 0; k < 3; ++k) w[k] = turn[k];
      for (int k = 0; k < 3 && type == mjJNT_FREE; ++k) v[k] = own.v[k];
    }
  }

  BodyId parentOf(int body) const {  // -1: the world, or one that does not move
    const int parent = model_->body_parentid[body];
    for (std::size_t i = 1; i < ids_.size(); ++i) {
      if (parent > 0 && ids_[i] == parent) return static_cast<BodyId>(i);
    }
    return -1;
  }

  Vec3 carried(BodyId i, BodyId parent) const {  // by its parent [m/s]
    if (parent < 0) return Vec3::Zero();
    const physics::Velocity& by = plan_.start.velocity[parent];
    return by.v + by.w.cross(plan_.start.pose[i].x - plan_.start.pose[parent].x);
  }

  void applyForces() {
    if (plan_.forces.empty()) return;
    state_ = plan_.start;
    read(state_.pose, state_.velocity);
    const std::vector<PeerLoad>& loads = plan_.forces.evaluate(state_);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (ids_[i] < 0) continue;
      for (int k = 0; k < 3; ++k) {
        data_->xfrc_applied[6 * ids_[i] + k] = loads[i].force[k];
        data_->xfrc_applied[6 * ids_[i] + 3 + k] = loads[i].torque[k];
      }
    }
  }

  Blueprint plan_;
  std::unique_ptr<mjModel, Freeing> model_;
  std::unique_ptr<mjData, Freeing> data_;
  std::vector<int> ids_;  // MuJoCo's, by BodyId; -1: it does not move
  PeerState state_;
};

PeerStart startMujoco(const physics::World& world, int iterations) {
  Blueprint plan = makeBlueprint(world);
  if (!plan.refusal.empty()) return {nullptr, plan.refusal};
  const Forest forest = findTrees(world, plan);
  const std::string refusal = mujocoRefusal(world, plan, forest);
  if (!refusal.empty()) return {nullptr, refusal};
  try {
    auto peer = std::make_unique<MujocoPeer>(world, std::move(plan), forest, iterations);
    if (startsAsGiven(*peer, world.bodies())) return {std::move(peer), ""};
    return {nullptr, "a joint opens at the start, which joint coordinates cannot express"};
  } catch (const std::runtime_error& error) {  // too large, or a shape that it refuses
    return {nullptr, error.what()};
  }
}

}  // namespace

PeerOffer mujocoOffer() {
  mjOption defaults;
  mj_defaultOption(&defaults);
  PeerMethod method{"mujoco", "MuJoCo", "MuJoCo",
                    "joint coordinates, soft contacts by Newton's method; all at its defaults but "
                    "the step, springs as explicit forces",
                    defaults.iterations};
  return {{"MuJoCo", std::string(mj_versionString()) + ", double precision", "libmujoco-dev"},
          {{method, startMujoco}}};
}

}  // namespace app
