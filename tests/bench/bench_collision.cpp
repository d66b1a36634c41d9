// Time of one detection: a pyramid at rest, the same with every pair looked at again, and a heap.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "physics/collision/collider.h"

namespace {

using namespace physics;

constexpr double kMargin = 0.02;

struct Scene {
  Collider collider;
  std::vector<Pose> poses = {Pose{}};

  void add(const Shape& shape, const Pose& pose, bool movable) {
    collider.add(static_cast<BodyId>(poses.size()), shape, movable);
    poses.push_back(pose);
  }
};

Scene pyramid(int base) {
  Scene scene;
  scene.add(Plane{}, Pose{}, false);
  for (int row = 0; row < base; ++row) {
    for (int i = 0; i < base - row; ++i) {
      scene.add(Box{}, {Vec3(1.1 * (i + 0.5 * row), row + 0.5, 0), Quat::Identity()}, true);
    }
  }
  return scene;
}

double number(std::mt19937& random) { return static_cast<double>(random()) / 4294967296.0 - 0.5; }

// Boxes of different sizes, turned at random and pressed together so that each touches about six.
Scene heap(int side) {
  Scene scene;
  std::mt19937 random(1);
  scene.add(Plane{}, Pose{}, false);
  for (int i = 0; i < side * side * side; ++i) {
    const Vec3 cell(i % side, i / side % side, i / side / side);
    Pose pose;
    pose.x = cell + Vec3{number(random), number(random) + 0.6, number(random)} * 0.1;
    pose.q = Quat{1, number(random), number(random), number(random)}.normalized();
    scene.add(Box{Vec3(0.9, 0.8, 1)}, pose, true);
  }
  return scene;
}

void report(benchmark::State& state, const Scene& scene, std::size_t manifolds) {
  state.counters["pairs"] = scene.collider.counts().pairs;
  state.counters["manifolds"] = static_cast<double>(manifolds);
  state.counters["narrow"] =
      benchmark::Counter(static_cast<double>(scene.collider.counts().narrowPhaseCalls),
                         benchmark::Counter::kAvgIterations);
}

void find(benchmark::State& state, Scene scene, double shake) {
  std::vector<Pose> there = scene.poses;
  std::mt19937 random(2);
  for (std::size_t i = 2; i < there.size(); ++i) {
    there[i].x += shake * Vec3{number(random), number(random), number(random)};
  }
  bool back = false;
  std::size_t manifolds = 0;
  for (auto _ : state) {
    const auto& poses = back ? there : scene.poses;
    manifolds = scene.collider.find(poses, poses, kMargin).size();
    back = !back;
  }
  report(state, scene, manifolds);
}

void restingPyramid(benchmark::State& state) { find(state, pyramid(20), 0); }
void movingPyramid(benchmark::State& state) { find(state, pyramid(20), 2e-3); }
void restingHeap(benchmark::State& state) { find(state, heap(10), 0); }
void movingHeap(benchmark::State& state) { find(state, heap(10), 2e-3); }

BENCHMARK(restingPyramid)->Unit(benchmark::kMicrosecond);
BENCHMARK(movingPyramid)->Unit(benchmark::kMicrosecond);
BENCHMARK(restingHeap)->Unit(benchmark::kMicrosecond);
BENCHMARK(movingHeap)->Unit(benchmark::kMicrosecond);

// Everything flies, so that bounds are left and pairs change in each step.
void fallingHeap(benchmark::State& state) {
  Scene scene = heap(10);
  const Vec3 step(0, -0.1, 0);
  std::vector<Pose> next = scene.poses;
  std::size_t manifolds = 0;
  for (auto _ : state) {
    state.PauseTiming();
    for (std::size_t i = 2; i < next.size(); ++i) {
      scene.poses[i].x = next[i].x + Vec3(0, next[i].x.y() > 2 ? 0 : 10, 0);
      next[i].x = scene.poses[i].x + step;
    }
    state.ResumeTiming();
    manifolds = scene.collider.find(scene.poses, next, kMargin).size();
  }
  report(state, scene, manifolds);
}
BENCHMARK(fallingHeap)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
