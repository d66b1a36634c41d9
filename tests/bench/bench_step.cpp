// One step of the scenes that engines are compared on (DESIGN's figures to beat), gravity 9.81, h =
// 1/60. Every row also counts the largest overlap or gap it ended with: a time without an error
// says little.
#include <benchmark/benchmark.h>

#include <string>

#include "scenes/simulation.h"

namespace {

const std::string kWorld = R"(
[gravity]
acceleration = [0, -9.81, 0]
[contact]
friction = 0.6
[[body]]
name = "ground"
shape = { plane = { normal = [0, 1, 0], offset = 0 } }
)";

scenes::Simulation simulate(const std::string& simulation, const std::string& bodies) {
  return scenes::Simulation(scenes::parseScene(
      "title = \"bench\"\nduration = 1000\n[simulation]\nfps = 60\n" + simulation + bodies,
      "bench"));
}

double largestGap(const physics::World& world) {
  double largest = 0;
  for (const auto& error : world.constraintErrors()) {
    if (error.unit == "m") largest = std::max(largest, error.largest);
  }
  return largest;
}

// Runs `frames` frames untimed first, so that what is timed is the state named by the benchmark.
void step(benchmark::State& state, const std::string& simulation, const std::string& bodies,
          int frames) {
  scenes::Simulation run = simulate(simulation, bodies);
  for (int k = 0; k < frames; ++k) run.advance();
  double overlap = 0, gap = 0;
  for (auto _ : state) {
    run.advance();
    state.PauseTiming();
    overlap = std::max(overlap, run.world().largestOverlap());
    gap = std::max(gap, largestGap(run.world()));
    state.ResumeTiming();
  }
  state.counters["overlap_mm"] = 1e3 * overlap;
  state.counters["gap_mm"] = 1e3 * gap;
}

const std::string kSweeps = "method = \"nonlinear_gauss_seidel\"\n";
const std::string kResting = "substeps = 2\niterations = 1\n";
const std::string kFalling = "substeps = 4\niterations = 1\n";

std::string pyramid() { return kWorld + "[[pyramid]]\nname = \"p\"\nbase = 20\nmass = 1\n"; }
std::string tower(int count) {
  return kWorld +
         "[[stack]]\nname = \"s\"\nmass = 1\nshape = { box = { size = [1, 1, 1] } }\ncount = " +
         std::to_string(count) + "\n";
}
std::string heap(int side) {
  return kWorld + "[[grid]]\nname = \"g\"\nmass = 1\nshapes = [{ box = { size = [1, 1, 1] } }]\n" +
         "position = [0, 0.6, 0]\nspacing = [1.1, 1.3, 1.1]\njitter = 0.03\ncounts = [" +
         std::to_string(side) + ", " + std::to_string(side) + ", " + std::to_string(side) + "]\n";
}
std::string chain(int count, double end) {
  return "[gravity]\nacceleration = [0, -9.81, 0]\n[[chain]]\nname = \"c\"\nfrom = [0, 5, 0]\n"
         "direction = [1, 0, 0]\nlength = 0.2\nradius = 0.03\nmass = 1\ncount = " +
         std::to_string(count) + "\nend = { mass = " + std::to_string(end) + " }\n";
}
// Boxes side by side on the ground, and one that is falling from far above.
std::string boxes(int side, const std::string& effect) {
  return kWorld + effect + "[[grid]]\nname = \"g\"\nmass = 1\n" +
         "shapes = [{ box = { size = [1, 1, 1] } }]\nposition = [0, 0.5, 0]\n" +
         "spacing = [2, 1, 2]\ncounts = [" + std::to_string(side) + ", 1, " + std::to_string(side) +
         "]\n[[body]]\nname = \"falls\"\nmass = 1\nshape = { sphere = { radius = 0.5 } }\n" +
         "position = [0, 300, 0]\n";
}
std::string chainAndBoxes() {
  const std::string swings = chain(20, 100);  // brings gravity along
  return swings + kWorld.substr(kWorld.find("[contact]")) +
         "[[grid]]\nname = \"g\"\nmass = 1\nshapes = [{ box = { size = [1, 1, 1] } }]\n" +
         "position = [50, 0.5, 0]\nspacing = [2, 1, 2]\ncounts = [15, 1, 15]\n";
}
std::string ragdolls() {
  return kWorld +
         "[[ragdoll]]\nname = \"d\"\nskeleton = \"human\"\nposition = [0, 0.5, 0]\n"
         "copies = { counts = [5, 4, 5], spacing = [0.8, 1.9, 0.8], jitter = 0.1, turn_degrees = "
         "90 }\n";
}

}  // namespace

BENCHMARK_CAPTURE(step, pyramid20, kResting, pyramid(), 60)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, tower50, "substeps = 4\niterations = 8\n", tower(50), 60)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, chain20_direct, "substeps = 1\niterations = 3\nmethod = \"direct\"\n",
                  chain(20, 1), 0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, chain20_direct_1000, "substeps = 1\niterations = 3\nmethod = \"direct\"\n",
                  chain(20, 1000), 0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, chain20_gauss_seidel, kSweeps + "substeps = 20\niterations = 1\n",
                  chain(20, 1), 0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, chain100_direct, "substeps = 1\niterations = 3\nmethod = \"direct\"\n",
                  chain(100, 1), 0)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, ragdolls100, "substeps = 8\niterations = 1\n", ragdolls(), 0)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(120);
BENCHMARK_CAPTURE(step, boxes10000_awake, kFalling, boxes(100, ""), 60)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);
BENCHMARK_CAPTURE(step, boxes10000_asleep, kFalling, boxes(100, "[sleep]\n"), 60)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(100);
BENCHMARK_CAPTURE(step, chain_and_boxes_substeps_everywhere, kSweeps + "substeps = 20\n",
                  chainAndBoxes(), 60)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, chain_and_boxes_local_substeps,
                  kSweeps + "substeps = 20\nlocal_substeps = true\n", chainAndBoxes(), 60)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(step, heap125, kFalling, heap(5), 0)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(240);
BENCHMARK_CAPTURE(step, heap1000, kFalling, heap(10), 0)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(120);
BENCHMARK_CAPTURE(step, heap8000, kFalling, heap(20), 0)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(20);

BENCHMARK_MAIN();
