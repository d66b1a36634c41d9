// A step of the default method allocates nothing once what it holds has found its size.
#include <gtest/gtest.h>

#include "physics/make/chain.h"
#include "physics/make/cloth.h"
#include "physics/make/soft_body.h"
#include "physics/make/stack.h"
#include "physics/world.h"
#include "tests/physics/collision/scene_of_two.h"

namespace physics {
namespace {

using testing::allocationCount;

Settings byDefault() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}

BodyId body(World& world, const Shape& shape, const Vec3& x, double mass = 1,
            Motion motion = Motion::kDynamic) {
  BodyDef def;
  def.shape = shape;
  def.mass = mass;
  def.pose.x = x;
  def.motion = motion;
  return world.add(def);
}

void ground(World& world) { body(world, Plane{}, Vec3::Zero(), 1, Motion::kStatic); }

void pyramid(World& world) {
  PyramidDef def;
  def.base = 8;
  def.place.position.x() = -20;
  add(world, def);
}

// Lying: a trunk and four limbs, with limits and drives.
void figure(World& world, const Vec3& x) {
  const BodyId trunk = body(world, Box{Vec3(0.6, 0.2, 0.4)}, x + Vec3(0, 0.1, 0), 20);
  for (const Vec3& side :
       {Vec3(1, 0, 0.5), Vec3(1, 0, -0.5), Vec3(-1, 0, 0.5), Vec3(-1, 0, -0.5)}) {
    const Vec3 at = x + Vec3(0.32 * side.x(), 0.1, 0.3 * side.z());
    BodyDef def;
    def.shape = Capsule{0.08, 0.3};
    def.mass = 3;
    def.pose = {at + Vec3(0.2 * side.x(), -0.02, 0), testing::turned(Vec3::UnitZ(), 90)};
    const BodyId limb = world.add(def);
    BallSocketDef joint;
    joint.bodies = {trunk, limb};
    joint.at = at;
    world.add(joint);
    ConeLimitDef limit;
    limit.bodies = {trunk, limb};
    world.add(limit);
    DriveDef drive;
    drive.bodies = {trunk, limb};
    world.add(drive);
  }
}

void figures(World& world) {
  for (int k = 0; k < 5; ++k) figure(world, Vec3(2.0 * k, 0, 10));
}

void chain(World& world) {
  ChainDef def;
  def.from = Vec3(0, 8, -10);
  def.direction = Vec3::UnitX();
  def.count = 20;
  def.length = 0.2;
  add(world, def);
}

// Over a peg, a ball at either end.
void rope(World& world) {
  constexpr double kPeg = 0.2, kThick = 0.02, kPiece = 0.05;
  const Vec3 centre(0, 4, -20);
  BodyDef peg;
  peg.shape = Cylinder{kPeg, 1};
  peg.pose = {centre, testing::turned(Vec3::UnitX(), 90)};
  peg.motion = Motion::kStatic;
  world.add(peg);
  const double around = kPeg + kThick, half = 0.5 * kPi * around;
  RopeLengthDef all;
  SoftSurfaceDef surface;
  surface.radius = kThick;
  for (int k = -30; k <= 30; ++k) {
    const double way = k * kPiece, angle = std::clamp(way, -half, half) / around;
    const double below = std::max(std::abs(way) - half, 0.0);
    const Vec3 x = centre + Vec3(around * std::sin(angle), around * std::cos(angle) - below, 0);
    all.bodies.push_back(body(world, PointShape{}, x, std::abs(k) == 30 ? 5 : 0.02));
    if (all.bodies.size() == 1) continue;
    LinkDef link;
    link.bodies = {all.bodies.end()[-2], all.bodies.back()};
    world.add(link);
    surface.links.push_back(link.bodies);
  }
  world.add(all);
  world.add(surface);
}

void hangingCloth(World& world) {
  ClothDef def;
  def.position = Vec3(0, 5, 20);
  def.nodes = {15, 15};
  def.pins = ClothPins::kTwoCorners;
  add(world, def);
}

void lyingCloth(World& world) {
  ClothDef def;
  def.position = Vec3(5, 0.01, 20);
  def.nodes = {10, 10};
  add(world, def);
}

void softBody(World& world) {
  SoftBodyDef def;
  def.place.position = Vec3(0, 0.51, 30);
  def.box = TetBox{};
  add(world, def);
}

struct Case {
  const char* name;
  std::vector<void (*)(World&)> build;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

std::vector<Case> cases() {
  std::vector<Case> all = {
      {"Pyramid", {pyramid}},  {"Figures", {figures}},           {"Chain", {chain}},
      {"RopeOnAPeg", {rope}},  {"HangingCloth", {hangingCloth}}, {"LyingCloth", {lyingCloth}},
      {"SoftBody", {softBody}}};
  Case mixed = {"AllOfThem", {}};
  for (const Case& c : all) mixed.build.push_back(c.build.front());
  all.push_back(mixed);
  return all;
}

class StepAllocation : public ::testing::TestWithParam<Case> {};

TEST_P(StepAllocation, NoneOnceTheStepHasFoundItsSize) {
  World world(byDefault());
  ground(world);
  for (const auto build : GetParam().build) build(world);
  for (int k = 0; k < 50; ++k) world.step();
  const long before = allocationCount();
  for (int k = 0; k < 50; ++k) ASSERT_FALSE(world.step().notFinite);
  EXPECT_EQ(allocationCount() - before, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StepAllocation, ::testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace physics
