// Trees of bodies on ball sockets and of points on links: what their motions keep, and that lanes
// are bytes apart.
#include "physics/accurate/joint_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "physics/base/rotation.h"
#include "physics/world.h"

namespace physics {
namespace {

enum class Of { kSockets, kLinks };

// A trunk of unequal moments that two arms hang on, of which one holds a hand; held by the world at
// its foot, or flying. Or points and links in the place of bodies and sockets.
struct Figure {
  std::vector<JointTree::Body> bodies;
  std::vector<JointTree::Joint> joints;
  IslandState start;
  std::shared_ptr<const JointTopology> topology;

  Figure(Of of, bool isHeld) {
    const double length = of == Of::kLinks ? 0.5 : 0;
    std::vector<std::array<BodyId, 2>> pairs = {{1, 2}, {1, 3}, {3, 4}};
    std::vector<JointTree::Joint> at = {{{Vec3(0.3, 0.4, 0), Vec3(-0.3, 0, 0)}, length},
                                        {{Vec3(-0.3, 0.4, 0.1), Vec3(0, 0.3, 0)}, length},
                                        {{Vec3(0, -0.3, 0), Vec3(0, 0.1, 0.05)}, length}};
    if (isHeld) {
      pairs.push_back({0, 1});
      at.push_back({{Vec3::Zero(), Vec3(0, -0.5, 0)}, length});
    }
    const bool turns = of == Of::kSockets;
    if (isHeld) add(Vec3::Zero(), 0, false, Vec3::Zero());
    add(Vec3(0, 0.5, 0), 5, turns, Vec3(0.4, 0.1, 0.3));
    add(Vec3(0.3, 0.9, 0), 1, turns, Vec3(0.02, 0.05, 0.03));
    add(Vec3(-0.3, 0.8, 0.1), 2, turns, Vec3(0.02, 0.05, 0.03));
    add(Vec3(-0.5, 0.5, -0.1), 3, turns, Vec3(0.02, 0.05, 0.03));
    const std::size_t first = isHeld ? 1 : 0;
    start.velocity[first] = {Vec3(1, 0, 2), Vec3(0.4, 1, -2)};
    start.velocity[first + 1] = {Vec3(-1, 1, 1), Vec3(3, 0, 1)};
    start.velocity[first + 3] = {Vec3(0, 2, -3), Vec3(0, -5, 2)};

    std::vector<InverseMass> masses(isHeld ? 0 : 1);
    std::vector<BodyId> ids;
    for (const JointTree::Body& body : bodies) {
      ids.push_back(static_cast<BodyId>(masses.size()));
      masses.push_back({body.moves ? 1 / body.mass : 0, Mat3::Zero()});
    }
    std::vector<JointRef> refs;
    std::vector<JointKind> kinds;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      refs.push_back({0, static_cast<int>(k)});
      JointKind kind;
      kind.rows = turns ? 3 : 1;
      kind.bodyCount = 2;
      kind.bodies = pairs[k];
      kind.seen = turns ? JointSeen::kGap : JointSeen::kByKind;
      kind.hasLinear = true;
      kinds.push_back(kind);
    }
    JointTopologies known;
    topology = topologyOf(refs, kinds, ids, masses, known);
    for (const int i : topology->order) joints.push_back(at[i]);
  }
  void add(const Vec3& x, double mass, bool turns, const Vec3& inertia) {
    bodies.push_back({mass > 0, turns, mass, inertia});
    start.pose.push_back({x, Quat::Identity()});
    start.velocity.push_back({});
  }
  // No joint of it is open where it begins.
  JointTree tree() {
    std::optional<JointTree> made = JointTree::of(topology, joints, bodies);
    EXPECT_TRUE(made.has_value());
    const std::vector<Vec3> pull(bodies.size(), Vec3(0, -9.81, 0)),
        none(bodies.size(), Vec3::Zero());
    made->push(pull, none);
    made->run(1, 1, start, 0);
    made->place(start);
    return *made;
  }
};

IslandState after(Figure& figure, int columns, int steps, double time) {
  JointTree tree = figure.tree();
  IslandState state = figure.start;
  for (int k = 0; k < steps; ++k) {
    tree.run(1, columns, state, time / steps);
    tree.end(columns - 1, state);
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

class JointTrees : public ::testing::TestWithParam<Of> {};
INSTANTIATE_TEST_SUITE_P(Both, JointTrees, ::testing::Values(Of::kSockets, Of::kLinks),
                         [](const auto& of) {
                           return of.param == Of::kLinks ? "Links" : "Sockets";
                         });

TEST_P(JointTrees, GiveTheSameBytesInAnyRegisters) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  Figure figure(GetParam(), true);
  JointTree tree = figure.tree();
  IslandState narrow, wide;
  for (const double time : {0.01, 3.0}) {  // turns of more than a radian too
    tree.run(1, 7, figure.start, time, kTreeKernelsSse2);
    tree.end(4, narrow);
    tree.run(1, 7, figure.start, time, kTreeKernelsAvx2);
    tree.end(4, wide);
    EXPECT_TRUE(isSame(narrow, wide)) << time;
  }
}

TEST_P(JointTrees, MotionsDoNotKnowWhoIsBesideThem) {
  Figure figure(GetParam(), true);
  JointTree tree = figure.tree();
  for (const auto& [first, columns] : {std::pair{1, 1}, {1, 4}, {1, 7}, {3, 4}, {9, 4}, {2, 7}}) {
    for (int row = 0; row < columns; ++row) {
      const int n = first + row;
      IslandState beside, alone, stepped = figure.start;
      tree.run(first, columns, figure.start, 0.02);
      tree.end(row, beside);
      tree.run(n, 1, figure.start, 0.02);
      tree.end(0, alone);
      EXPECT_TRUE(isSame(beside, alone)) << n << " of " << first << " and " << columns;
      for (int k = 0; k < n; ++k) {
        tree.run(1, 1, stepped, 0.02 / n);
        tree.end(0, stepped);
      }
      for (std::size_t i = 1; i < stepped.pose.size(); ++i) {  // half steps are made together
        EXPECT_LT((stepped.pose[i].x - alone.pose[i].x).norm(), 1e-13);
      }
    }
  }
}

// A step back from where a step ends, spins turned round, is where it began.
TEST_P(JointTrees, StepsAreSymmetricInTime) {
  Figure figure(GetParam(), true);
  JointTree tree = figure.tree();
  IslandState state, back;
  tree.run(1, 1, figure.start, 0.05);
  tree.end(0, state);
  EXPECT_GT((state.pose[4].x - figure.start.pose[4].x).norm(), 0.01);
  for (Velocity& velocity : state.velocity) velocity = {-velocity.v, -velocity.w};
  tree.run(1, 1, state, 0.05);
  tree.end(0, back);
  for (std::size_t i = 1; i < back.pose.size(); ++i) {
    EXPECT_LT((back.pose[i].x - figure.start.pose[i].x).norm(), 1e-13);
    EXPECT_LT((back.velocity[i].v + figure.start.velocity[i].v).norm(), 1e-12);
    EXPECT_LT((back.velocity[i].w + figure.start.velocity[i].w).norm(), 1e-12);
  }
}

TEST_P(JointTrees, KeepWhatTheirMotionKeeps) {
  for (const bool isHeld : {false, true}) {
    Figure figure(GetParam(), isHeld);
    const IslandState coarse = after(figure, 1, 1600, 1), fine = after(figure, 1, 3200, 1);
    const Sums start = sumsOf(figure, figure.start), a = sumsOf(figure, coarse),
               b = sumsOf(figure, fine);
    const double errorOfA = std::abs(a.energy - start.energy),
                 errorOfB = std::abs(b.energy - start.energy);
    EXPECT_LT(errorOfB, 1e-3 * start.energy);
    EXPECT_NEAR(errorOfA / errorOfB, 4, 0.4);
    if (isHeld) continue;
    double mass = 0;
    for (const JointTree::Body& body : figure.bodies) mass += body.mass;
    EXPECT_LT((b.momentum - start.momentum - mass * Vec3(0, -9.81, 0)).norm(), 1e-11);
    EXPECT_NEAR((a.spin - start.spin).norm() / (b.spin - start.spin).norm(), 4, 0.4);
  }
}

// What T_kk says of places is not of links as long as they are.
TEST_P(JointTrees, CloseWhatIsNearAnEnd) {
  Figure figure(GetParam(), true);
  JointTree tree = figure.tree();
  IslandState end;
  tree.run(1, 2, figure.start, 0.02);
  tree.end(1, end);
  IslandState near = end;
  for (std::size_t i = 1; i < near.pose.size(); ++i) {
    near.pose[i].x += 1e-3 * Vec3(1, static_cast<double>(i), -2);
    near.velocity[i].v += 1e-3 * Vec3(1, static_cast<double>(i), -2);
  }
  tree.place(near);
  for (std::size_t k = 0; GetParam() == Of::kLinks && k < figure.joints.size(); ++k) {
    const int* body = figure.topology->shapes[k].body;
    const Vec3 way = near.pose[body[1]].x - near.pose[body[0]].x,
               parting = near.velocity[body[1]].v - near.velocity[body[0]].v;
    EXPECT_NEAR(way.norm(), 0.5, 1e-15);
    EXPECT_NEAR(way.dot(parting), 0, 1e-14);
  }
  for (std::size_t i = 1; i < near.pose.size(); ++i) {
    EXPECT_LT((near.pose[i].x - end.pose[i].x).norm(), GetParam() == Of::kLinks ? 0.05 : 1e-14);
  }
}

// About its middle axis, with a little of the others: it turns over again and again.
TEST(JointTree, OfOneBodyTumblesFreely) {
  JointTopologies known;
  const std::vector<BodyId> ids = {1};
  const std::vector<InverseMass> masses = {{}, {1, Mat3::Zero()}};
  const std::vector<JointTree::Body> bodies = {{true, true, 1, Vec3(0.1, 0.2, 0.25)}};
  std::optional<JointTree> tree = JointTree::of(topologyOf({}, {}, ids, masses, known), {}, bodies);
  ASSERT_TRUE(tree.has_value());
  const std::vector<Vec3> none = {Vec3::Zero()};
  tree->push(none, none);
  IslandState start;
  start.pose.resize(1);
  start.velocity = {{Vec3(1, 2, 3), Vec3(0.1, 10, 0.2)}};
  const auto momentum = [&](const IslandState& state) -> Vec3 {
    const Quat& q = state.pose[0].q;
    return q * bodies[0].inertia.cwiseProduct(q.conjugate() * state.velocity[0].w);
  };
  const auto energyOff = [&](int columns, int steps) {
    IslandState state = start;
    for (int k = 0; k < steps; ++k) {
      tree->run(1, columns, state, 2.0 / steps);
      tree->end(columns - 1, state);
    }
    EXPECT_LT((state.pose[0].x - Vec3(2, 4, 6)).norm(), 1e-12);
    EXPECT_LT((momentum(state) - momentum(start)).norm(), 1e-12);
    return std::abs(momentum(state).dot(state.velocity[0].w) -
                    momentum(start).dot(start.velocity[0].w));
  };
  EXPECT_LT(energyOff(1, 2000), 1e-3);  // J of 20
}

TEST(JointTree, IsNoneWhereItMayNotBe) {
  Figure held(Of::kSockets, true), points(Of::kLinks, true);
  held.bodies[4].moves = false;  // the hand stands as well
  EXPECT_FALSE(JointTree::of(held.topology, held.joints, held.bodies).has_value());
  points.bodies[2].turns = true;
  EXPECT_FALSE(JointTree::of(points.topology, points.joints, points.bodies).has_value());
}

}  // namespace
}  // namespace physics
