// Pictures of runs: the state that they end in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/study/results.h"
#include "render/renderer.h"
#include "scenes/view/view.h"

namespace app {

struct StudyShot {
  std::string file;     // name in the output folder
  std::string caption;  // "cheapest of ours to 1 %: direct, bdf2, h = 0.01 s"
  RunKey key;
};

// The points worth looking at: the best, the cheapest to 1 % of ours and of the peers, the worst.
std::vector<StudyShot> chooseShots(const CaseResults& results);

// Runs again and draws those whose file is not there. False: interrupted.
bool drawShots(const CaseResults& results, const std::vector<StudyShot>& shots,
               const std::filesystem::path& folder);

// Of all studies: small, with strokes to match.
scenes::ViewOptions shotOptions();
std::unique_ptr<render::Renderer> openShotRenderer();
void writeShot(render::Renderer& renderer, const render::Picture& picture,
               const std::filesystem::path& file);

}  // namespace app
