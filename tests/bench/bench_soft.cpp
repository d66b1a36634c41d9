// A step of cloths of growing size, and of the same nodes as points and as rigid bodies: a point
// must not pay for a rotation that it does not have. Gravity 100, h = 1/60, 8 iterations, links in
// rows and columns, two corners held.
#include <benchmark/benchmark.h>

#include "physics/world.h"

namespace {

using namespace physics;

struct Grid {
  World world;
  std::vector<BodyId> nodes;
  int side;
  BodyId at(int i, int j) const { return nodes[static_cast<std::size_t>(i * side + j)]; }
};

Settings settings() {
  Settings s;
  s.method = Method::kNonlinearGaussSeidel;
  s.substeps = 1;
  s.iterations = 8;
  s.gravity = Vec3(0, -100, 0);
  return s;
}

template <class AddLink>
Grid cloth(int side, const Shape& shape, AddLink addLink) {
  Grid grid{World(settings()), {}, side};
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      BodyDef def;
      def.shape = shape;
      def.pose.x = Vec3(j, 0, i) / side;
      if (i == 0 && (j == 0 || j == side - 1)) def.motion = Motion::kStatic;
      grid.nodes.push_back(grid.world.add(def));
    }
  }
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      if (j + 1 < side) addLink(grid.world, grid.at(i, j), grid.at(i, j + 1));
      if (i + 1 < side) addLink(grid.world, grid.at(i, j), grid.at(i + 1, j));
    }
  }
  return grid;
}

void run(benchmark::State& state, World& world, int nodes) {
  for (int k = 0; k < 10; ++k) world.step();
  for (auto _ : state) world.step();
  state.counters["nodes"] =
      benchmark::Counter(nodes, benchmark::Counter::kIsIterationInvariantRate);
}

void link(World& world, BodyId a, BodyId b) {
  LinkDef def;
  def.bodies = {a, b};
  world.add(def);
}

void distance(World& world, BodyId a, BodyId b) {
  DistanceDef def;
  def.bodies = {a, b};
  world.add(def);
}

void clothOfPoints(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  Grid grid = cloth(side, PointShape{}, link);
  run(state, grid.world, side * side);
}

void clothWithTotalLength(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  Grid grid = cloth(side, PointShape{}, link);
  for (int i = 0; i < side; ++i) {
    RopeLengthDef row, column;
    for (int j = 0; j < side; ++j) {
      row.bodies.push_back(grid.at(i, j));
      column.bodies.push_back(grid.at(j, i));
    }
    grid.world.add(row);
    grid.world.add(column);
  }
  run(state, grid.world, side * side);
}

// What the nodes would cost as small spheres held by distances: bodies that can turn.
void clothOfBodies(benchmark::State& state) {
  const int side = static_cast<int>(state.range(0));
  Grid grid = cloth(side, Sphere{0.001}, distance);
  run(state, grid.world, side * side);
}

}  // namespace

BENCHMARK(clothOfPoints)
    ->Arg(10)
    ->Arg(20)
    ->Arg(50)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(clothWithTotalLength)
    ->Arg(10)
    ->Arg(20)
    ->Arg(100)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(clothOfBodies)->Arg(100)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
