// A whole rendered frame: stepping, view, drawing on threads and PNG writing, overlapped as figures
// do it.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "app/run/frame_folder.h"
#include "app/run/pipeline.h"
#include "render/png.h"
#include "scenes/view/view.h"

namespace {

constexpr int kFrames = 60;  // enough to make little of opening the contexts

struct TemporaryFolder {
  std::filesystem::path path;
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "dbd-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path); }
};

// Arguments: quality, width, height, threads.
void renderFrames(benchmark::State& state) {
  setenv("LP_NUM_THREADS", "0", 1);
  const TemporaryFolder output;
  const app::FrameFolder frames(output.path);
  const scenes::Scene scene = scenes::readScene("pyramid");
  scenes::MotionBounds bounds;
  bounds.include(scenes::Simulation(scene));
  const render::RendererOptions options{static_cast<int>(state.range(1)),
                                        static_cast<int>(state.range(2)),
                                        static_cast<render::Quality>(state.range(0)), ""};
  for (auto _ : state) {
    scenes::Simulation simulation(scene);
    app::Pipeline pipeline(options, static_cast<int>(state.range(3)),
                           [&frames](int frame, const render::Image& image) {
                             render::writePng(image, frames.file(frame));
                           });
    for (int frame = 0; frame < kFrames; ++frame) {
      pipeline.draw(frame, scenes::view(simulation, bounds, {}, {}));
      simulation.advance();
    }
    pipeline.finish();
  }
  state.SetItemsProcessed(state.iterations() * kFrames);  // items: frames
}

void arguments(benchmark::internal::Benchmark* bench) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (const int threads : {1, cores}) {
    bench->Args({static_cast<int>(render::Quality::kDraft), 640, 360, threads});
    bench->Args({static_cast<int>(render::Quality::kStandard), 1280, 720, threads});
    bench->Args({static_cast<int>(render::Quality::kPaper), 1920, 1080, threads});
    if (cores == 1) break;
  }
}
BENCHMARK(renderFrames)
    ->Apply(arguments)
    ->ArgNames({"quality", "width", "height", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
