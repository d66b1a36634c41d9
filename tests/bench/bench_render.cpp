// Milliseconds of a 1280 x 720 frame by quality, and of a PNG file.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "render/png.h"
#include "render/renderer.h"
#include "tests/render/sample.h"

namespace {

void drawFrames(benchmark::State& state, const render::Picture& picture) {
  render::RendererOptions options;
  options.quality = static_cast<render::Quality>(state.range(0));
  render::Renderer renderer(options);
  renderer.draw(picture);  // compiles the shaders
  for (auto _ : state) benchmark::DoNotOptimize(renderer.draw(picture).rgb.data());
}

void boxes(benchmark::State& state) { drawFrames(state, render::pyramidPicture(20)); }
void capsules(benchmark::State& state) { drawFrames(state, render::ragdollPicture(20)); }

void cloth(benchmark::State& state) { drawFrames(state, render::clothPicture(100)); }
void noCloth(benchmark::State& state) {
  render::Picture picture = render::clothPicture(100);
  picture.surfaces.clear();
  drawFrames(state, picture);
}

void overlay(benchmark::State& state) {
  render::Picture picture = render::samplePicture();
  picture.hud = render::sampleHud(240);
  drawFrames(state, picture);
}

void png(benchmark::State& state) {
  const render::Image image = render::Renderer({}).draw(render::pyramidPicture(20));
  const auto file = std::filesystem::temp_directory_path() / "bench_render.png";
  for (auto _ : state) render::writePng(image, file);
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::remove(file);
}

}  // namespace

// 0 draft, 1 standard, 2 paper
BENCHMARK(boxes)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(capsules)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(cloth)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(noCloth)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(overlay)->DenseRange(0, 2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(png)->Unit(benchmark::kMillisecond)->UseRealTime();
