// Numbers of many frames in few bytes, as assets/player/take.js reads them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/take/take.h"

namespace app {

class TakeNumbers {
 public:
  void add(const std::vector<float>& numbers);
  void add(const std::vector<std::uint32_t>& numbers);

  // Rows of one length, a row a frame. Each column has its least number and a step (<f4), and where
  // that is not zero 16 bits a frame: how many steps above the least, within half a step of 1/65535
  // of the column's range; as differences from the frame before, folded (0 -1 1 -2 ... to 0 1 2 3
  // ...), all low bytes before all high ones, so that what rests takes next to nothing.
  void addTracks(const std::vector<std::vector<float>>& rows);

  // How many strokes each frame has (<u4), the style of each (a byte), least and step of each
  // coordinate over the whole layer, then x y z of `from` and of `to` as columns of 16 bits, `to`
  // as the difference from `from`; all as differences from the stroke with the same number in the
  // frame before, folded and parted likewise.
  void addLayer(const TakeLayer& layer);

  std::string packed() const;  // deflated, base64

 private:
  void addBytes(const void* bytes, std::size_t count);  // filled up to whole fours
  void addParted(const std::vector<std::uint16_t>& numbers);

  std::string bytes_;
};

}  // namespace app
