// Finding the trees that joints make of bodies, breadth first from a static body or from the first.
#include "app/peers/tree.h"

#include <algorithm>
#include <cmath>

#include "physics/base/rotation.h"

namespace app {
namespace {

using physics::BodyId;
using physics::Motion;
using physics::Vec3;
using Kind = PeerJoint::Kind;

constexpr double kSameStart =
    1e-6;                       // m, m/s, rad/s: what joint coordinates may take from the start
constexpr double kFlat = 1e-9;  // of a length: what leaves the plane by less is in it

class Finder {
 public:
  Finder(const physics::World& world, const Blueprint& plan)
      : world_(world), plan_(plan), taken_(static_cast<std::size_t>(world.bodyCount()), false) {}

  Forest find() {
    for (const PeerJoint& joint : plan_.joints) {  // those that hang from something first
      for (const int side : {0, 1}) {
        const BodyId base = joint.bodies[side], first = joint.bodies[1 - side];
        if (!isMovable(world_, base) && isMovable(world_, first) && !taken_[first]) {
          if (world_.bodies().motion[base] == Motion::kKinematic) {
            forest_.refusal = "Bullet's articulated bodies do not hang from a body that is moved";
          }
          grow({base, true, {}, {}}, first, &joint, 1 - side);
        }
      }
    }
    for (const PeerJoint& joint : plan_.joints) {
      if (!taken_[joint.bodies[0]] && isMovable(world_, joint.bodies[0])) {
        taken_[joint.bodies[0]] = true;
        Tree tree{joint.bodies[0], false, {}, {}};
        attach(tree, tree.base, -1);
        finish(std::move(tree));
      }
    }
    return std::move(forest_);
  }

 private:
  void grow(Tree tree, BodyId first, const PeerJoint* joint, int side) {
    taken_[first] = true;
    tree.links.push_back({first, tree.base, -1, joint, side});
    finish(std::move(tree));
  }

  // All that hangs on this body and is not in a tree yet.
  void attach(Tree& tree, BodyId body, int index) {
    for (const PeerJoint& joint : plan_.joints) {
      for (const int side : {0, 1}) {
        const BodyId child = joint.bodies[side];
        if (joint.bodies[1 - side] != body || !isMovable(world_, child) || taken_[child]) continue;
        taken_[child] = true;
        tree.links.push_back({child, body, index, &joint, side});
      }
    }
  }

  void finish(Tree tree) {
    for (std::size_t k = 0; k < tree.links.size(); ++k) {
      attach(tree, tree.links[k].body, static_cast<int>(k));
    }
    for (const TreeLink& link : tree.links) {
      if (link.joint->kind == Kind::kUniversal) {
        forest_.refusal = "Bullet's articulated bodies have no universal joint";
      }
    }
    if (closesLoop(tree)) forest_.refusal = "Bullet's articulated bodies are trees, without loops";
    findPlane(tree);
    forest_.trees.push_back(std::move(tree));
  }

  bool closesLoop(const Tree& tree) const {
    const auto has = [&](BodyId body) {
      return (body == tree.base && !tree.isFixed) ||
             std::any_of(tree.links.begin(), tree.links.end(),
                         [&](const TreeLink& link) { return link.body == body; });
    };
    const auto joints = std::count_if(
        plan_.joints.begin(), plan_.joints.end(),
        [&](const PeerJoint& joint) { return has(joint.bodies[0]) || has(joint.bodies[1]); });
    return joints > static_cast<std::ptrdiff_t>(tree.links.size());
  }

  // A point on a rod turns about its parent in the plane of all motion.
  void findPlane(Tree& tree) {
    std::vector<Vec3> within;
    bool rods = false, others = !tree.isFixed;
    for (const TreeLink& link : tree.links) {
      const bool rod = link.joint->kind == Kind::kDistance;
      (rod && isPoint(world_, link.body) ? rods : others) = true;
      within.push_back(plan_.start.pose[link.body].x -
                       anchorAtStart(plan_, *link.joint, 1 - link.side));
      within.push_back(plan_.start.velocity[link.body].v);
    }
    const bool anyRod = std::any_of(tree.links.begin(), tree.links.end(), [](const TreeLink& link) {
      return link.joint->kind == Kind::kDistance;
    });
    if (!anyRod) return;
    if (others || !rods) {
      forest_.refusal = "Bullet's articulated bodies keep distances only of points that hang";
      return;
    }
    within.push_back(world_.settings().gravity.value_or(Vec3::Zero()));
    tree.plane = normalTo(within);
    for (const Vec3& v : within) {
      if (std::abs(v.dot(*tree.plane)) > kFlat * v.norm()) {
        forest_.refusal = "Bullet's articulated bodies keep distances only of points in one plane";
      }
    }
  }

  static Vec3 normalTo(const std::vector<Vec3>& vectors) {
    const Vec3 first = vectors.front().normalized();
    Vec3 normal = Vec3::Zero();
    for (const Vec3& v : vectors) {
      const Vec3 candidate = first.cross(v.normalized());
      if (candidate.norm() > normal.norm()) normal = candidate;
    }
    return normal.norm() > kFlat ? normal.normalized() : physics::anyNormalTo(first);
  }

  const physics::World& world_;
  const Blueprint& plan_;
  std::vector<bool> taken_;
  Forest forest_;
};

}  // namespace

bool startsAsGiven(const Peer& peer, const physics::Bodies& b) {
  PeerState state{b.pose, b.velocity};
  peer.read(state.pose, state.velocity);
  double worst = 0;
  for (BodyId i = 0; i < b.size(); ++i) {
    worst = std::max({worst, (state.pose[i].x - b.pose[i].x).norm(),
                      (state.velocity[i].v - b.velocity[i].v).norm(),
                      (state.velocity[i].w - b.velocity[i].w).norm()});
  }
  return worst < kSameStart;
}

Forest findTrees(const physics::World& world, const Blueprint& plan) {
  return Finder(world, plan).find();
}

}  // namespace app
