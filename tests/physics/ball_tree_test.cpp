// Trees of bodies on ball sockets: what their motions keep, and that lanes are bytes apart.
#include "physics/accurate/ball_tree.h"

#include <gtest/gtest.h>

#include "physics/base/rotation.h"
#include "physics/world.h"

namespace physics {
namespace {

// A trunk of unequal moments that two arms hang on, of which one holds a hand; held by the world at
// its foot, or flying.
struct Figure {
  std::vector<BallTree::Body> bodies;
  std::vector<std::array<Vec3, 2>> anchors;
  IslandState start;
  std::shared_ptr<const JointTopology> topology;

  explicit Figure(bool isHeld) {
    std::vector<std::array<int, 2>> pairs = {{1, 2}, {1, 3}, {3, 4}};
    std::vector<std::array<Vec3, 2>> at = {{Vec3(0.3, 0.4, 0), Vec3(-0.3, 0, 0)},
                                           {Vec3(-0.3, 0.4, 0.1), Vec3(0, 0.3, 0)},
                                           {Vec3(0, -0.3, 0), Vec3(0, 0.1, 0.05)}};
    if (isHeld) {
      pairs.push_back({0, 1});
      at.push_back({Vec3::Zero(), Vec3(0, -0.5, 0)});
    }
    add({}, 0, Vec3::Zero());
    add({Vec3(0, 0.5, 0), Quat::Identity()}, 5, Vec3(0.4, 0.1, 0.3));
    for (int k = 0; k < 3; ++k) add({}, 1.0 + k, Vec3(0.02, 0.05, 0.03));
    start.velocity[1].w = Vec3(0.4, 1, -2);
    start.velocity[2].w = Vec3(3, 0, 1);
    start.velocity[4].w = Vec3(0, -5, 2);

    const int first = isHeld ? 0 : 1;
    std::vector<InverseMass> masses;
    for (const BallTree::Body& body : bodies) {
      masses.push_back({body.moves ? 1 / body.mass : 0, Mat3::Zero()});
    }
    std::vector<BodyId> ids;
    for (int k = first; k < 5; ++k) ids.push_back(k);
    std::vector<JointRef> refs;
    std::vector<JointKind> kinds;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      refs.push_back({0, static_cast<int>(k)});
      JointKind kind;
      kind.rows = 3;
      kind.bodyCount = 2;
      kind.bodies = {pairs[k][0], pairs[k][1]};
      kind.seen = JointSeen::kGap;
      kinds.push_back(kind);
    }
    JointTopologies known;
    topology = topologyOf(refs, kinds, ids, masses, known);
    for (const int i : topology->order) anchors.push_back(at[i]);
    if (!isHeld) {
      bodies.erase(bodies.begin());
      start.pose.erase(start.pose.begin());
      start.velocity.erase(start.velocity.begin());
    }
  }
  void add(const Pose& pose, double mass, const Vec3& inertia) {
    bodies.push_back({mass > 0, mass > 0, mass, inertia});
    start.pose.push_back(pose);
    start.velocity.push_back({});
  }
  // No joint of it open, at rest where it begins.
  BallTree tree() {
    std::optional<BallTree> made = BallTree::of(topology, anchors, bodies);
    EXPECT_TRUE(made.has_value());
    const std::vector<Vec3> pull(bodies.size(), Vec3(0, -9.81, 0)),
        none(bodies.size(), Vec3::Zero());
    made->push(pull, none);
    made->run(1, start, 0);
    made->place(start);
    return *made;
  }
};

IslandState after(Figure& figure, int columns, int steps, double time) {
  BallTree tree = figure.tree();
  IslandState state = figure.start;
  for (int k = 0; k < steps; ++k) {
    tree.run(columns, state, time / steps);
    tree.end(columns, state);
  }
  return state;
}

struct Sums {
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();  // about the centre of mass
  double energy = 0;
};
Sums sumsOf(const Figure& figure, const IslandState& state) {
  Sums sums;
  Vec3 centre = Vec3::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < figure.bodies.size(); ++i) {
    mass += figure.bodies[i].mass;
    centre += figure.bodies[i].mass * state.pose[i].x;
  }
  centre /= mass;
  for (std::size_t i = 0; i < figure.bodies.size(); ++i) {
    const auto& [pose, velocity] = std::tie(state.pose[i], state.velocity[i]);
    const Vec3 own =
        pose.q * figure.bodies[i].inertia.cwiseProduct(pose.q.conjugate() * velocity.w);
    const Vec3 p = figure.bodies[i].mass * velocity.v;
    sums.momentum += p;
    sums.spin += own + (pose.x - centre).cross(p);
    sums.energy +=
        0.5 * (p.dot(velocity.v) + own.dot(velocity.w)) + 9.81 * figure.bodies[i].mass * pose.x.y();
  }
  return sums;
}

bool isSame(const IslandState& a, const IslandState& b) {
  for (std::size_t i = 0; i < a.pose.size(); ++i) {
    const Pose &p = a.pose[i], &q = b.pose[i];
    const Velocity &v = a.velocity[i], &w = b.velocity[i];
    if (p.x != q.x || p.q.coeffs() != q.q.coeffs() || v.v != w.v || v.w != w.w) return false;
  }
  return true;
}

TEST(BallTree, GivesTheSameBytesInAnyRegisters) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  Figure figure(true);
  BallTree tree = figure.tree();
  IslandState narrow, wide;
  for (const double time : {0.01, 3.0}) {  // turns of more than a radian too
    tree.run(7, figure.start, time, kTreeKernelsSse2);
    tree.end(5, narrow);
    tree.run(7, figure.start, time, kTreeKernelsAvx2);
    tree.end(5, wide);
    EXPECT_TRUE(isSame(narrow, wide)) << time;
  }
}

TEST(BallTree, MotionsDoNotKnowWhoIsBesideThem) {
  Figure figure(true);
  BallTree tree = figure.tree();
  for (int columns = 1; columns <= 7; ++columns) {
    for (int n = 1; n <= columns; ++n) {
      IslandState beside, alone, stepped = figure.start;
      tree.run(columns, figure.start, 0.02);
      tree.end(n, beside);
      tree.run(n, figure.start, 0.02);
      tree.end(n, alone);
      EXPECT_TRUE(isSame(beside, alone)) << n << " of " << columns;
      for (int k = 0; k < n; ++k) {
        tree.run(1, stepped, 0.02 / n);
        tree.end(1, stepped);
      }
      for (std::size_t i = 1; i < stepped.pose.size(); ++i) {  // half steps are made together
        EXPECT_LT((stepped.pose[i].x - alone.pose[i].x).norm(), 1e-13);
      }
    }
  }
}

// A step back from where a step ends, spins turned round, is where it began.
TEST(BallTree, StepsAreSymmetricInTime) {
  Figure figure(true);
  BallTree tree = figure.tree();
  IslandState state;
  tree.run(1, figure.start, 0.05);
  tree.end(1, state);
  EXPECT_GT((state.pose[4].x - figure.start.pose[4].x).norm(), 0.01);
  for (Velocity& velocity : state.velocity) velocity = {-velocity.v, -velocity.w};
  IslandState back;
  tree.run(1, state, 0.05);
  tree.end(1, back);
  for (std::size_t i = 1; i < back.pose.size(); ++i) {
    EXPECT_LT((back.pose[i].x - figure.start.pose[i].x).norm(), 1e-13);
    EXPECT_LT((back.velocity[i].w + figure.start.velocity[i].w).norm(), 1e-12);
  }
}

TEST(BallTree, KeepsWhatItsMotionKeeps) {
  for (const bool isHeld : {false, true}) {
    Figure figure(isHeld);
    const IslandState coarse = after(figure, 1, 800, 1), fine = after(figure, 1, 1600, 1);
    const Sums start = sumsOf(figure, figure.start), a = sumsOf(figure, coarse),
               b = sumsOf(figure, fine);
    const double errorOfA = std::abs(a.energy - start.energy),
                 errorOfB = std::abs(b.energy - start.energy);
    EXPECT_LT(errorOfB, 1e-3 * start.energy);
    EXPECT_NEAR(errorOfA / errorOfB, 4, 0.4);
    if (isHeld) continue;
    double mass = 0;
    for (const BallTree::Body& body : figure.bodies) mass += body.mass;
    EXPECT_LT((b.momentum - start.momentum - mass * Vec3(0, -9.81, 0)).norm(), 1e-11);
    EXPECT_NEAR((a.spin - start.spin).norm() / (b.spin - start.spin).norm(), 4, 0.4);
  }
}

TEST(BallTree, IsNoneWhereJointsCloseALoop) {
  Figure figure(true);
  figure.bodies[4].moves = false;  // the hand stands as well
  EXPECT_FALSE(BallTree::of(figure.topology, figure.anchors, figure.bodies).has_value());
}

}  // namespace
}  // namespace physics
