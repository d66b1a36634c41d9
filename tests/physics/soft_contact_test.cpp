// Points and links against rigid bodies.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "tests/physics/pair.h"
#include "tests/physics/sweeps.h"

namespace physics::testing {
namespace {

constexpr double kRadius = 0.02;

struct Scene {
  World world;
  SoftSurfaceDef soft;
  explicit Scene(double friction = 0.5, int substeps = 4, bool gravity = true)
      : world(settingsOf(friction, substeps, gravity)) {
    soft.radius = kRadius;
    soft.friction = {friction, friction};
  }
  static Settings settingsOf(double friction, int substeps, bool gravity) {
    Settings settings = sweeps();
    settings.substeps = substeps;
    settings.iterations = 10;
    if (gravity) settings.gravity = Vec3(0, -9.81, 0);
    settings.contact.emplace();
    settings.contact->friction = {friction, friction};
    return settings;
  }
  BodyId rigid(const Shape& shape, const Vec3& x, Motion motion = Motion::kStatic) {
    BodyDef def;
    def.shape = shape;
    def.pose.x = x;
    def.motion = motion;
    return world.add(def);
  }
  BodyId point(const Vec3& x, const Vec3& v = Vec3::Zero(), double mass = 0.1) {
    BodyDef def;
    def.mass = mass;
    def.pose.x = x;
    def.velocity.v = v;
    return world.add(def);
  }
  void run(int steps) {
    for (int k = 0; k < steps; ++k) ASSERT_FALSE(world.step().notFinite);
  }
  Vec3 at(BodyId body) const { return world.bodies().pose[body].x; }
};

// A rope of `count` points along x at a height, linked and touching.
std::vector<BodyId> ropeAcross(Scene& scene, int count, double from, double to, double height) {
  std::vector<BodyId> nodes;
  for (int i = 0; i < count; ++i) {
    nodes.push_back(scene.point(Vec3(from + (to - from) * i / (count - 1), height, 0)));
  }
  for (int i = 0; i + 1 < count; ++i) {
    LinkDef link;
    link.bodies = {nodes[i], nodes[i + 1]};
    scene.world.add(link);
    scene.soft.links.push_back({nodes[i], nodes[i + 1]});
  }
  scene.world.add(scene.soft);
  return nodes;
}

TEST(SoftContact, APointRestsOnThePlaneAtItsRadius) {
  Scene scene;
  scene.rigid(Plane{}, Vec3::Zero());
  const BodyId node = scene.point(Vec3(0, 0.3, 0));
  scene.soft.nodes = {node};
  scene.world.add(scene.soft);
  scene.run(120);
  EXPECT_NEAR(scene.at(node).y(), kRadius, 1e-9);
  EXPECT_EQ(scene.world.contactCount(), 1);
}

TEST(SoftContact, APointRestsOnEveryShape) {
  const Shape shapes[] = {Box{Vec3(1, 0.4, 1)}, Sphere{0.2}, Capsule{0.2, 0.1}, Cylinder{0.5, 0.4}};
  const double tops[] = {0.2, 0.2, 0.25, 0.2};
  for (int i = 0; i < 4; ++i) {
    Scene scene;
    scene.rigid(shapes[i], Vec3::Zero());
    const BodyId node = scene.point(Vec3(0, 0.6, 0));
    scene.soft.nodes = {node};
    scene.world.add(scene.soft);
    scene.run(120);
    EXPECT_NEAR(scene.at(node).y(), tops[i] + kRadius, 1e-6) << i;
  }
}

TEST(SoftContact, ALinkHangsOverAnEdgeThatPassesBetweenItsPoints) {
  Scene scene;
  scene.rigid(Box{Vec3(0.02, 0.5, 1)}, Vec3(0, 0, 0));  // a blade between two points
  const auto nodes = ropeAcross(scene, 2, -0.3, 0.3, 0.4);
  scene.run(120);
  EXPECT_NEAR(0.5 * (scene.at(nodes[0]).y() + scene.at(nodes[1]).y()), 0.25 + kRadius, 2e-3);
}

TEST(SoftContact, ARopeFallsOverABallAndStaysOutside) {
  Scene scene(0.6);
  scene.rigid(Sphere{0.5}, Vec3::Zero());
  const auto nodes = ropeAcross(scene, 21, -0.7, 0.7, 0.7);
  scene.run(180);
  for (const BodyId node : nodes) EXPECT_GT(scene.at(node).norm(), 0.5 + kRadius - 1e-3);
  EXPECT_LT(scene.at(nodes.front()).y(), 0.3);  // and it hangs down on both sides
  EXPECT_LT(scene.at(nodes.back()).y(), 0.3);
}

TEST(SoftContact, NothingPassesAThinWallAtOneHundredMetresPerSecond) {
  for (const int substeps : {1, 4}) {
    Scene scene(0.5, substeps, false);
    scene.rigid(Box{Vec3(0.01, 4, 4)}, Vec3::Zero());
    const BodyId node = scene.point(Vec3(-1, 0, 0), Vec3(100, 0, 0));
    scene.soft.nodes = {node};
    scene.world.add(scene.soft);
    scene.run(30);
    EXPECT_LT(scene.at(node).x(), -0.005 - kRadius + 1e-9) << substeps;
  }
}

TEST(SoftContact, FrictionHoldsAPointOnASlopeBelowItsAngleAndLetsItSlideAbove) {
  for (const double degrees : {25.0, 29.0}) {  // atan 0.5 = 26.6
    Scene scene(0.5);
    const double angle = degrees * kDegree;
    scene.rigid(Plane{Vec3(std::sin(angle), std::cos(angle), 0), 0}, Vec3::Zero());
    const Vec3 n(std::sin(angle), std::cos(angle), 0);
    const BodyId node = scene.point(kRadius * n);
    scene.soft.nodes = {node};
    scene.world.add(scene.soft);
    scene.run(60);
    const double way = (scene.at(node) - kRadius * n).norm();
    const double exact = 0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
    if (degrees < 26) {
      EXPECT_LT(way, 1e-9);
    } else {
      EXPECT_NEAR(way, exact, 0.02 * exact);
    }
  }
}

TEST(SoftContact, KeepsTheMomentumOfAPointThatHitsAFreeBody) {
  Scene scene(0.5, 4, false);
  const BodyId box = scene.rigid(Box{Vec3(0.5, 0.5, 0.5)}, Vec3::Zero(), Motion::kDynamic);
  const BodyId node = scene.point(Vec3(-1, 0.2, 0.05), Vec3(5, 0, 0), 0.5);
  scene.soft.nodes = {node};
  scene.world.add(scene.soft);
  const auto momentum = [&] {
    const Bodies& b = scene.world.bodies();
    return (b.mass[box] * b.velocity[box].v + b.mass[node] * b.velocity[node].v).eval();
  };
  const Vec3 before = momentum();
  scene.run(60);
  EXPECT_LT((momentum() - before).norm(), 1e-13);
  EXPECT_GT(scene.world.bodies().velocity[box].v.x(), 0.1);
  EXPECT_GT(std::abs(scene.world.bodies().velocity[box].w.z()), 0.1);
}

TEST(SoftContact, PartsAnOverlapNoFasterThanAskedByTheDefault) {
  Settings settings = Scene::settingsOf(0.5, 4, false);
  settings.method = Method::kSmallSteps;
  Scene scene;
  scene.world = World(settings);
  scene.rigid(Plane{}, Vec3::Zero());
  const BodyId node = scene.point(Vec3(0, -0.2, 0));
  scene.soft.nodes = {node};
  scene.world.add(scene.soft);
  for (int k = 0; k < 60; ++k) {
    scene.run(1);
    EXPECT_LE(scene.world.bodies().velocity[node].v.norm(), 1 + 1e-9);
  }
  EXPECT_GE(scene.at(node).y(), kRadius - 1e-9);
}

// A link from a node that is held to one that lies on a block through it, or the other way round.
struct HeldLink {
  World world;
  explicit HeldLink(bool heldFirst, Motion motion = Motion::kStatic) : world(settings()) {
    BodyDef held, free, block;
    held.pose.x = Vec3(0, 1, 0);
    held.mass = free.mass = 0.1;
    held.motion = Motion::kStatic;
    free.pose.x = Vec3(0.4, 1, 0);
    block.shape = Box{Vec3(0.1, 0.2, 8)};
    block.pose.x = Vec3(0.3, 1 - kRadius - 0.1, 0);
    block.motion = motion;
    const BodyId a = world.add(held), b = world.add(free);
    SoftSurfaceDef soft;
    soft.radius = kRadius;
    soft.friction = {0, 0};
    LinkDef link;
    link.bodies = heldFirst ? PerBody<2, BodyId>{a, b} : PerBody<2, BodyId>{b, a};
    world.add(link);
    soft.links.push_back({link.bodies[0], link.bodies[1]});
    world.add(soft);
    const BodyId under = world.add(block);
    if (motion == Motion::kKinematic) world.setVelocity(under, {Vec3(0, 0, 0.3), Vec3::Zero()});
  }
  static Settings settings() {
    Settings settings;
    settings.gravity = Vec3(0, -9.81, 0);
    settings.contact.emplace();
    settings.contact->friction = {0, 0};
    settings.sleep.emplace();
    settings.sleep->time = 0.2;
    settings.substeps = 4;
    return settings;
  }
};

TEST(SoftContact, TellsTheSameImpulseWhicheverEndOfALinkIsHeld) {
  const auto impulseOf = [](bool heldFirst) {
    HeldLink scene(heldFirst);
    for (int k = 0; k < 10; ++k) scene.world.step();
    double sum = 0;
    for (const ContactReport& contact : scene.world.contacts()) sum += contact.impulse.norm();
    return sum;
  };
  EXPECT_GT(impulseOf(false), 0);
  EXPECT_NEAR(impulseOf(true), impulseOf(false), 1e-6 * impulseOf(false));
}

TEST(SoftContact, DoesNotSleepOnWhatMovesWhicheverEndOfALinkIsHeld) {
  for (const bool heldFirst : {true, false}) {
    HeldLink scene(heldFirst, Motion::kKinematic);
    int most = 0;
    for (int k = 0; k < 60; ++k) most = std::max(most, scene.world.step().asleep);
    EXPECT_GT(scene.world.contactCount(), 0);
    EXPECT_EQ(most, 0) << heldFirst;
  }
}

}  // namespace
}  // namespace physics::testing
