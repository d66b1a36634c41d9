// Which of the bodies that cast shadows stand as they did in the picture before: they stay in a
// layer of the shadow map that need not be drawn again. Plain numbers, no OpenGL.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace render {

// A body as the shadow map sees it.
struct Caster {
  std::size_t shape = 0, upload = 0;  // its geometry on the GPU; places are used again
  std::array<float, 4> place{}, turn{}, scale{};
  bool operator==(const Caster&) const = default;
};

// All else that the map depends on: the matrix of the light, the ground's height and whether it
// hides what is below it.
using ShadowView = std::array<float, 18>;

// What is to be drawn into the map. Only the nearest depth stays, whatever the order of drawing: a
// map made of layers is the same map, bit for bit.
struct ShadowWork {
  bool nothing = false;                    // the map is what it was
  bool newLayer = false;                   // draw `still` into the layer first
  bool fromLayer = false;                  // the map begins as a copy of the layer
  std::vector<std::size_t> still, moving;  // casters by index; `moving` go over the copy
};

class StillCasters {
 public:
  // The casters of the next picture, in its order. `sheets`: surfaces are drawn besides, of which
  // nothing is known.
  ShadowWork next(const std::vector<Caster>& casters, const ShadowView& view, bool sheets);

 private:
  std::vector<bool> heldByLayer(const std::vector<Caster>& casters, const ShadowView& view);
  void makeLayer(const std::vector<Caster>& casters, const ShadowView& view, ShadowWork& work);

  bool known_ = false, sheets_ = false;  // of the picture before, as the next two
  ShadowView view_{};
  std::vector<Caster> last_;
  std::vector<std::size_t> layer_;    // the casters in the layer, by index
  std::vector<Caster> layerCasters_;  // and as they were drawn
  ShadowView layerView_{};
};

}  // namespace render
