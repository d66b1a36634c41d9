// Worlds on a mesh of triangles: a flat one is as a plane, and nothing falls through any.
#include "physics/bodies/triangles.h"

#include <gtest/gtest.h>

#include "physics/base/rotation.h"
#include "physics/bodies/compound.h"
#include "tests/physics/stage.h"

namespace physics::testing {
namespace {

Settings bySteps() {
  Settings settings;
  settings.gravity = Vec3(0, -9.81, 0);
  settings.contact = ContactSettings{};
  return settings;
}

// Cells of `pitch` about the origin, of this height [m] at x and z.
template <class F>
Triangles ground(int cells, double pitch, F&& height) {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = pitch * (i - 0.5 * cells), z = pitch * (j - 0.5 * cells);
      vertices.emplace_back(x, height(x, z), z);
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      triangles.push_back({a, c, d});
      triangles.push_back({a, d, b});
    }
  }
  return {makeTriangleMesh(vertices, triangles)};
}
double level(double, double) { return 0; }
double hills(double x, double z) {
  return 0.5 * sineCosine(1.1 * x).sine * sineCosine(0.9 * z).cosine;
}

void addFixed(World& world, const Shape& shape) {
  BodyDef def;
  def.shape = shape;
  def.motion = Motion::kStatic;
  world.add(def);
}

struct Way {
  Vec3 end = Vec3::Zero();
  double highest = 0, fastestUp = 0;  // m above the start, m/s
};

Way slide(const Settings& settings, const Shape& ground, const Shape& shape, double height) {
  World world(settings);
  addFixed(world, ground);
  BodyDef def;
  def.shape = shape;
  def.pose = {Vec3(-3.3, height, 0.07), exponential(Vec3(0, 0.3, 0))};
  def.velocity.v = Vec3(5, 0, 0.4);
  const BodyId id = world.add(def);
  Way way;
  for (int k = 0; k < 150; ++k) {
    world.step();
    way.highest = std::max(way.highest, world.bodies().pose[id].x.y() - height);
    way.fastestUp = std::max(way.fastestUp, std::abs(world.bodies().velocity[id].v.y()));
  }
  way.end = world.bodies().pose[id].x;
  return way;
}

// Over some forty inner edges, by the default and by the paper's method.
TEST(TriangleGround, LetsABallAndABoxSlideWithoutAKick) {
  const Triangles mesh = ground(60, 0.25, level);
  const Plane plane{};
  const Compound tray =
      makeCompound(
          std::vector<PartDef>{{Box{Vec3(0.6, 0.2, 0.3)}, {Vec3(0, 0, -0.2), Quat::Identity()}, 1},
                               {Box{Vec3(0.6, 0.2, 0.3)}, {Vec3(0, 0, 0.2), Quat::Identity()}, 1}})
          .compound;
  for (const Settings& settings : {bySteps(), grounded()}) {
    for (const auto& [shape, height] :
         std::vector<std::pair<Shape, double>>{{Sphere{0.2}, 0.2},
                                               {Box{Vec3(0.6, 0.3, 0.5)}, 0.15},
                                               {Cylinder{0.3, 0.4}, 0.2},
                                               {tray, 0.1}}) {
      const Way over = slide(settings, mesh, shape, height),
                on = slide(settings, plane, shape, height);
      EXPECT_GT(on.end.x(), -2);
      EXPECT_LT(over.highest, on.highest + 1e-4) << shape.index();
      EXPECT_LT(over.fastestUp, on.fastestUp + 0.02) << shape.index();
      EXPECT_NEAR((over.end - on.end).norm(), 0, 0.03) << shape.index();
    }
  }
}

// No centre gets further below the triangles than half of the thinnest body. Cells of 0.5 m lie
// below the hills by at most d^2/8 of the curvature, d their diagonal: 0.71^2 / 8 * 1.01 m.
TEST(TriangleGround, HoldsWhatComesAtAHundredMetresPerSecond) {
  constexpr double kSag = 0.064;
  const Triangles mesh = ground(80, 0.5, hills);
  const std::vector<Shape> shapes = {Sphere{0.15}, Box{Vec3(0.2, 0.2, 0.2)}, Capsule{0.1, 0.3},
                                     Cylinder{0.15, 0.2}};
  for (const Settings& settings : {bySteps(), grounded()}) {
    for (int i = 0; i < 24; ++i) {
      World world(settings);
      addFixed(world, mesh);
      BodyDef def;
      def.shape = shapes[i % shapes.size()];
      def.pose.x = Vec3(0.37 * (i % 5) - 1, 3 + 0.21 * (i % 7), 0.29 * (i % 3));
      const double lean = 0.3 * (i % 5);
      def.velocity = {100 * Vec3(sineCosine(lean).sine, -sineCosine(lean).cosine, 0),
                      Vec3(3, i % 4, 2)};
      const BodyId id = world.add(def);
      for (int k = 0; k < 60; ++k) {
        world.step();
        const Vec3& x = world.bodies().pose[id].x;
        if (std::abs(x.x()) > 19 || std::abs(x.z()) > 19) break;
        ASSERT_GT(x.y(), hills(x.x(), x.z()) - kSag - 0.1) << i << " in step " << k;
      }
    }
  }
}

// The bottom of a bowl of triangles: all come to rest in it.
TEST(TriangleGround, BringsAHeapToRestInAHollow) {
  World world(bySteps());
  addFixed(world, ground(24, 0.5, [](double x, double z) { return 0.15 * (x * x + z * z); }));
  for (int i = 0; i < 12; ++i) {
    const Vec3 x(0.9 * (i % 3) - 0.9, 1.5 + 0.5 * (i / 3), 0.8 * (i % 2) - 0.4);
    addBody(world, i % 2 == 0 ? Shape(Box{Vec3(0.4, 0.4, 0.4)}) : Shape(Sphere{0.2}), x);
  }
  run(world, 360);
  for (BodyId id = 2; id < world.bodyCount(); ++id) {
    EXPECT_GT(world.bodies().pose[id].x.y(), 0.05) << id;
    EXPECT_LT(world.bodies().velocity[id].v.norm(), 0.3) << id;
  }
  EXPECT_LT(world.largestOverlap(), 0.01);
}

TEST(TriangleGround, GivesTheSameBytesForAnyNumberOfThreads) {
  std::vector<Pose> first;
  for (const int threads : {1, 3}) {
    World world(bySteps());
    world.setThreads(threads);
    addFixed(world, ground(24, 0.5, hills));
    for (int i = 0; i < 60; ++i) {
      addBody(world, Box{Vec3(0.3, 0.4, 0.3)},
              Vec3(0.6 * (i % 5) - 1, 1 + 0.5 * (i / 10), 0.6 * (i % 4) - 1));
    }
    run(world, 60);
    if (first.empty()) first = world.bodies().pose;
    for (BodyId i = 0; i < world.bodyCount(); ++i) EXPECT_EQ(first[i].x, world.bodies().pose[i].x);
  }
}

// A row of linked points lies on the mesh.
TEST(TriangleGround, HoldsPointsOfARope) {
  World world(bySteps());
  addFixed(world, ground(12, 0.5, level));
  SoftSurfaceDef surface;
  surface.radius = 0.05;
  for (int i = 0; i < 6; ++i) {
    surface.nodes.push_back(addBody(world, PointShape{}, Vec3(0.2 * i - 0.5, 0.5, 0.13), 0.1));
  }
  for (int i = 0; i + 1 < 6; ++i) {
    LinkDef link;
    link.bodies = {surface.nodes[i], surface.nodes[i + 1]};
    world.add(link);
  }
  world.add(surface);
  run(world, 120);
  for (const BodyId node : surface.nodes) {
    EXPECT_NEAR(world.bodies().pose[node].x.y(), 0.05, 5e-3);
  }
}

TEST(TriangleGround, CannotMoveByItself) {
  World world(bySteps());
  BodyDef def;
  def.shape = ground(2, 1, level);
  EXPECT_THROW(world.add(def), std::invalid_argument);
}

}  // namespace
}  // namespace physics::testing
