// Nothing in the equations knows a place, a direction or an order: what is moved, turned, mirrored
// or declared in another order gives the moved, turned, mirrored, same result.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "physics/world.h"
#include "tests/physics/pair.h"

namespace physics::testing {
namespace {

// Where a copy of a scene is: x -> linear x + shift, `linear` a rotation or a mirror image of one.
struct Place {
  Mat3 linear = Mat3::Identity();
  Vec3 shift = Vec3::Zero();

  double handedness() const { return linear.determinant() < 0 ? -1 : 1; }
  Vec3 point(const Vec3& x) const { return linear * x + shift; }
  Vec3 axial(const Vec3& w) const { return handedness() * (linear * w); }
  // Shapes and inertias here are their own mirror images in body x.
  Quat turn(const Quat& q) const {
    const Vec3 own(handedness(), 1, 1);
    return Quat(Mat3(linear * q.toRotationMatrix() * own.asDiagonal())).normalized();
  }
  Pose pose(const Pose& p) const { return {point(p.x), turn(p.q)}; }
};

Place turned() { return {about(Vec3(1, 2, 3), 37 * kPi / 180).toRotationMatrix(), Vec3::Zero()}; }
Place mirrored() { return {Vec3(-1, 1, 1).asDiagonal(), Vec3::Zero()}; }
Place moved(double by) { return {Mat3::Identity(), Vec3(by, -0.5 * by, 0.7 * by)}; }
Place all() { return {turned().linear * mirrored().linear, Vec3(3, -1, 2)}; }

Settings settingsAt(const Place& place, Method method, Stepping stepping, int iterations) {
  Settings settings;
  settings.method = method;
  settings.stepping = stepping;
  settings.iterations = iterations;
  settings.gravity = place.linear * Vec3(0, -9.81, 0);
  return settings;
}

BodyDef bodyAt(const Place& place, const Shape& shape, const Vec3& x, const Quat& q, double mass) {
  BodyDef def;
  def.shape = shape;
  def.mass = mass;
  def.pose = place.pose({x, q});
  return def;
}

// Ten links from a point, held by balls, axles, a cone, a drive and a spring, the last one heavy.
World chainAt(const Place& place, Method method, Stepping stepping, bool backwards = false) {
  World world(settingsAt(place, method, stepping, 8));
  constexpr int kLinks = 10;
  const auto id = [&](int i) { return i < 0 ? kWorldBody : backwards ? kLinks - i : i + 1; };
  for (int k = 0; k < kLinks; ++k) {
    const int i = backwards ? kLinks - 1 - k : k;
    const double mass = i == kLinks - 1 ? 100 : 1;
    const Quat q = about(Vec3::UnitZ(), kPi / 2);
    BodyDef def = bodyAt(place, Capsule{0.05, 0.3}, Vec3(0.3 * i + 0.15, 0, 0), q, mass);
    def.velocity.w = place.axial(Vec3(3, 0.5, 0.2 * i));
    world.add(def);
  }
  for (int k = 0; k < kLinks; ++k) {
    const int i = backwards ? kLinks - 1 - k : k;
    const std::array<BodyId, 2> bodies{id(i - 1), id(i)};
    BallSocketDef ball;
    ball.bodies = bodies;
    ball.at = place.point(Vec3(0.3 * i, 0, 0));
    world.add(ball);
    if (i == 3) {
      AxleDef axle;
      axle.bodies = bodies;
      axle.axis = place.linear * Vec3(0, 0.6, 0.8);
      world.add(axle);
    }
    if (i == 5) {
      ConeLimitDef cone;
      cone.bodies = bodies;
      cone.axis = place.linear * Vec3::UnitX();
      cone.angle = 0.2;
      world.add(cone);
    }
    if (i == 7) {
      DriveDef drive;
      drive.bodies = bodies;
      drive.stiffness = 20;
      world.add(drive);
    }
  }
  SpringDef spring;
  spring.bodies = {kWorldBody, id(4)};
  spring.anchors[0] = place.point(Vec3(1, 1, 0.5));
  spring.stiffness = 50;
  world.add(spring);
  return world;
}

// Two boxes on one another, and a ball beside them that slides and rolls away: what 400 sweeps
// solve to rounding. (A box that slides on four points may share its weight between them in many
// ways.)
World pileAt(const Place& place, bool backwards = false) {
  Settings settings = settingsAt(place, Method::kNonlinearGaussSeidel, Stepping::kPaper, 400);
  settings.contact = ContactSettings{};
  World world(settings);
  std::vector<BodyDef> defs;
  BodyDef ground;
  const Vec3 up = place.linear * Vec3::UnitY();
  ground.shape = Plane{up, up.dot(place.shift)};
  ground.motion = Motion::kStatic;
  world.add(ground);
  for (int i = 0; i < 2; ++i) {
    defs.push_back(bodyAt(place, Box{Vec3::Ones()}, Vec3(0, i + 0.5, 0), Quat::Identity(), 1));
  }
  defs.push_back(bodyAt(place, Sphere{0.2}, Vec3(3, 0.2, 0), Quat::Identity(), 1));
  defs.back().velocity.v = place.linear * Vec3(2, 0, 0.5);
  if (backwards) std::reverse(defs.begin(), defs.end());
  for (const BodyDef& def : defs) world.add(def);
  return world;
}

void stepOn(World& world, int steps) {
  for (int k = 0; k < steps; ++k) ASSERT_FALSE(world.step().notFinite.has_value());
}

// The largest distance of a body from where its image should be; `reversed`: in the other order,
// from body `first` on.
double distance(const World& here, const World& there, const Place& place, int first = 1,
                bool reversed = false) {
  double largest = 0;
  const int last = here.bodyCount() - 1;
  for (BodyId b = first; b <= last; ++b) {
    const Pose& pose = here.bodies().pose[b];
    const Pose& image = there.bodies().pose[reversed ? first + last - b : b];
    largest = std::max(largest, (image.x - place.point(pose.x)).norm());
    largest = std::max(largest, image.q.angularDistance(place.turn(pose.q)));
  }
  return largest;
}

struct Change {
  const char* name;
  Place place;
  double chain, pile;  // m and rad, allowed
};

// Chains differ by rounding (2e-12 after a second), piles by which point of a manifold is found
// first (3e-7). At 1e6 m doubles are 1.2e-10 m apart (chains: 9e-8).
const Change kChanges[] = {{"Turned", turned(), 1e-9, 1e-6},
                           {"Mirrored", mirrored(), 1e-9, 1e-6},
                           {"Moved", moved(10), 1e-9, 1e-6},
                           {"TurnedMirroredAndMoved", all(), 1e-9, 1e-6},
                           {"AtTenKilometres", moved(1e4), 1e-8, 1e-6},
                           {"AtAThousandKilometres", moved(1e6), 1e-6, 1e-6}};

void PrintTo(const Change& change, std::ostream* out) { *out << change.name; }

class Symmetry : public ::testing::TestWithParam<Change> {};

TEST_P(Symmetry, OfAChainSolvedDirectly) {
  const Place& place = GetParam().place;
  World here = chainAt({}, Method::kDirect, Stepping::kBdf2);
  World there = chainAt(place, Method::kDirect, Stepping::kBdf2);
  stepOn(here, 60), stepOn(there, 60);
  EXPECT_GT((here.bodies().pose[10].x - Vec3(2.85, 0, 0)).norm(), 1);  // it has moved
  EXPECT_LT(distance(here, there, place), GetParam().chain);
}

TEST_P(Symmetry, OfAChainSolvedBySweeps) {
  const Place& place = GetParam().place;
  World here = chainAt({}, Method::kNonlinearGaussSeidel, Stepping::kPaper);
  World there = chainAt(place, Method::kNonlinearGaussSeidel, Stepping::kPaper);
  stepOn(here, 60), stepOn(there, 60);
  EXPECT_LT(distance(here, there, place), GetParam().chain);
}

TEST_P(Symmetry, OfAPile) {
  const Place& place = GetParam().place;
  World here = pileAt({}), there = pileAt(place);
  stepOn(here, 120), stepOn(there, 120);
  EXPECT_GT(here.bodies().pose[4].x.x(), 3.2);
  EXPECT_LT(distance(here, there, place, 2), GetParam().pile);
}

INSTANTIATE_TEST_SUITE_P(Ways, Symmetry, ::testing::ValuesIn(kChanges),
                         [](const auto& change) { return std::string(change.param.name); });

TEST(DeclarationOrder, DoesNotMatterToAChainSolvedDirectly) {
  World one = chainAt({}, Method::kDirect, Stepping::kBdf2);
  World other = chainAt({}, Method::kDirect, Stepping::kBdf2, true);
  stepOn(one, 60), stepOn(other, 60);
  EXPECT_LT(distance(one, other, {}, 1, true), 1e-9);
}

TEST(DeclarationOrder, MattersToAPileByLessThanAMicrometre) {
  World one = pileAt({}), other = pileAt({}, true);
  stepOn(one, 120), stepOn(other, 120);
  EXPECT_LT(distance(one, other, {}, 2, true), 1e-6);
}

}  // namespace
}  // namespace physics::testing
