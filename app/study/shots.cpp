// Draws end states, all of a case through the same camera.
#include "app/study/shots.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/output_file.h"
#include "app/run/open_renderer.h"
#include "app/study/accuracy.h"
#include "app/study/cheapest.h"
#include "app/base/numbers.h"
#include "render/png.h"

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr int kShotWidth = 480, kShotHeight = 320;
constexpr double kInk = 1.6;

void addShot(const CaseResults& results, const Trace* point, const std::string& why,
             std::vector<StudyShot>& shots) {
  if (point == nullptr) return;
  const auto same = std::find_if(shots.begin(), shots.end(),
                                 [&](const StudyShot& shot) { return shot.key == point->key; });
  if (same != shots.end()) {
    same->caption = why + ", " + same->caption;
    return;
  }
  const RunKey& key = point->key;
  const std::string name = fmt::format("{}_{}_{}", results.study.name, key.method,
                                       hashText(key.text() + point->inputs).substr(0, 6));
  shots.push_back(
      {"shots/" + name + ".png",
       fmt::format("{}: {}, {}, error {} {}, {} per s", why, results.methodTitle(*point),
                   key.text(), numberText(point->errors.error), results.study.unit,
                   secondsText(point->cost())),
       key});
}

}  // namespace

scenes::ViewOptions shotOptions() {
  scenes::ViewOptions options;
  options.aspect = static_cast<double>(kShotWidth) / kShotHeight;
  options.ink = kInk;
  return options;
}

std::unique_ptr<render::Renderer> openShotRenderer() {
  return openRenderer({kShotWidth, kShotHeight, render::Quality::kStandard, ""});
}

void writeShot(render::Renderer& renderer, const render::Picture& picture, const fs::path& file) {
  makeFolder(file.parent_path());
  render::writePng(renderer.draw(picture), file);
}

std::vector<StudyShot> chooseShots(const CaseResults& results) {
  constexpr double kMarked = kTargets[0], kGoodEnough = 2;
  const double target = kMarked * results.study.scale;
  std::vector<StudyShot> shots;
  const Trace* best = results.best();
  if (best == nullptr) return shots;
  std::vector<const Trace*> all;
  for (const Trace& point : results.points) all.push_back(&point);
  // Not the very finest, which may take long: no eye tells the two apart.
  addShot(results, cheapest(all, kGoodEnough * best->errors.error), "the least error", shots);
  addShot(results, cheapest(results.ours(), target), "the cheapest of ours to 1 %", shots);
  addShot(results, cheapest(results.peers(), target), "the cheapest other engine to 1 %", shots);
  addShot(results, results.worst(), "the largest error", shots);
  return shots;
}

bool drawShots(const CaseResults& results, const std::vector<StudyShot>& shots,
               const fs::path& folder) {
  const bool areThere = std::all_of(shots.begin(), shots.end(), [&](const StudyShot& shot) {
    return fs::exists(folder / shot.file);
  });
  if (areThere) return true;
  const scenes::StudyCase& study = results.study;
  const auto renderer = openShotRenderer();
  scenes::MotionBounds bounds;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    Trace named;
    named.key = shots[i].key;
    const auto m = static_cast<std::size_t>(results.methodOf(named));
    const Run run = runOf(study, study.methods[m], study.grids[m], named.key);
    const auto done = perform(run, [&](const scenes::Simulation& simulation, Trace& trace) {
      if (i == 0) bounds.include(simulation);  // the best run frames the others
      if (trace.frames < study.sampleCount()) return true;
      writeShot(*renderer, scenes::view(simulation, bounds, shotOptions(), {}),
                folder / shots[i].file);
      return true;
    });
    if (!done) return false;
  }
  return true;
}

}  // namespace app
