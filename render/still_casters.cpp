// Compares each picture's casters with those of the picture before.
#include "render/still_casters.h"

#include <algorithm>

namespace render {
namespace {

// A copy of the map costs about as much as this many boxes.
constexpr std::size_t kWorthALayer = 16;

}  // namespace

// By caster; none where one of the layer's has moved: the layer is given up.
std::vector<bool> StillCasters::heldByLayer(const std::vector<Caster>& casters,
                                            const ShadowView& view) {
  bool holds = view == layerView_ && (layer_.empty() || layer_.back() < casters.size());
  for (std::size_t k = 0; holds && k < layer_.size(); ++k) {
    holds = casters[layer_[k]] == layerCasters_[k];
  }
  if (!holds) layer_.clear();
  std::vector<bool> held(casters.size(), false);
  for (const std::size_t i : layer_) held[i] = true;
  return held;
}

void StillCasters::makeLayer(const std::vector<Caster>& casters, const ShadowView& view,
                             ShadowWork& work) {
  work.newLayer = true;
  layer_ = work.still;
  layerView_ = view;
  layerCasters_.clear();
  for (const std::size_t i : layer_) layerCasters_.push_back(casters[i]);
}

ShadowWork StillCasters::next(const std::vector<Caster>& casters, const ShadowView& view,
                              bool sheets) {
  ShadowWork work;
  const bool sameView = known_ && view == view_;
  work.nothing = sameView && !sheets && !sheets_ && casters == last_;
  if (work.nothing) return work;
  std::vector<bool> held = heldByLayer(casters, view);
  std::size_t more = 0;  // that stand still and are not in the layer
  for (std::size_t i = 0; sameView && i < std::min(casters.size(), last_.size()); ++i) {
    if (!held[i] && casters[i] != last_[i]) continue;
    work.still.push_back(i);
    more += held[i] ? 0 : 1;
  }
  if (more >= std::max(kWorthALayer, layer_.size() / 4)) {
    makeLayer(casters, view, work);
    for (const std::size_t i : layer_) held[i] = true;
  }
  work.fromLayer = !layer_.empty();
  for (std::size_t i = 0; i < casters.size(); ++i) {
    if (!held[i]) work.moving.push_back(i);
  }
  known_ = true;
  sheets_ = sheets;
  view_ = view;
  last_ = casters;
  return work;
}

}  // namespace render
