// Draws end states, all of a case through the same camera.
#include "app/study/study_shot.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/base/build_info.h"
#include "app/base/interrupt.h"
#include "app/run/open_renderer.h"
#include "app/study/study_run.h"
#include "app/study/study_table.h"
#include "render/png.h"
#include "scenes/view/view.h"

namespace app {

namespace {

namespace fs = std::filesystem;

constexpr int kShotWidth = 480, kShotHeight = 320;
constexpr double kInk = 1.6;

// Simulates a point to its end, shows every sample to `visit`. False: interrupted.
template <class Visit>
bool playPoint(const StudyResults& results, const StudyKey& key, Visit visit) {
  const scenes::StudyCase& study = results.study;
  StudyPoint point;
  point.key = key;
  const auto m = static_cast<std::size_t>(results.methodOf(point));
  const scenes::StudyMethod& method = study.methods[m];
  const scenes::Scene scene =
      scenes::studyScene(study, overridesOf(study.grids[m], method, study, key));
  StudyRun run(scene, study, method, key);
  visit(run.simulation(), study.sampleCount() == 1);
  for (int k = 1; k < study.sampleCount(); ++k) {
    if (interrupted()) return false;
    if (!run.advance()) break;
    visit(run.simulation(), k + 1 == study.sampleCount());
  }
  return true;
}

void addShot(const StudyResults& results, const StudyPoint* point, const std::string& why,
             std::vector<StudyShot>& shots) {
  if (point == nullptr) return;
  const auto same = std::find_if(shots.begin(), shots.end(),
                                 [&](const StudyShot& shot) { return shot.key == point->key; });
  if (same != shots.end()) {
    same->caption = why + ", " + same->caption;
    return;
  }
  const StudyKey& key = point->key;
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

std::vector<StudyShot> chooseShots(const StudyResults& results) {
  constexpr double kMarked = kTargets[0], kGoodEnough = 2;
  const double target = kMarked * results.study.scale;
  std::vector<StudyShot> shots;
  const StudyPoint* best = results.best();
  if (best == nullptr) return shots;
  std::vector<const StudyPoint*> all;
  for (const StudyPoint& point : results.points) all.push_back(&point);
  // Not the very finest, which may take long: no eye tells the two apart.
  addShot(results, cheapest(all, kGoodEnough * best->errors.error), "the least error", shots);
  addShot(results, cheapest(results.ours(), target), "the cheapest of ours to 1 %", shots);
  addShot(results, cheapest(results.peers(), target), "the cheapest other engine to 1 %", shots);
  addShot(results, results.worst(), "the largest error", shots);
  return shots;
}

bool drawShots(const StudyResults& results, const std::vector<StudyShot>& shots,
               const fs::path& folder, bool fresh) {
  const bool areThere = std::all_of(shots.begin(), shots.end(), [&](const StudyShot& shot) {
    return fs::exists(folder / shot.file);
  });
  if (shots.empty() || (areThere && !fresh)) return true;
  fs::create_directories(folder / "shots");
  scenes::MotionBounds bounds;
  const auto renderer = openRenderer({kShotWidth, kShotHeight, render::Quality::kStandard, ""});
  for (std::size_t i = 0; i < shots.size(); ++i) {
    scenes::ViewOptions options;
    options.aspect = static_cast<double>(kShotWidth) / kShotHeight;
    options.ink = kInk;
    const auto visit = [&](const scenes::Simulation& simulation, bool isLast) {
      if (i == 0) bounds.include(simulation);  // the best run frames the others
      if (!isLast) return;
      const render::Picture picture = scenes::view(simulation, bounds, options, {});
      render::writePng(renderer->draw(picture), folder / shots[i].file);
    };
    if (!playPoint(results, shots[i].key, visit)) return false;
  }
  return true;
}

}  // namespace app
