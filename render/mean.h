// The mean of pictures that were drawn one after the other.
#pragma once

#include <cstdint>
#include <vector>

namespace render {

// Of pixels of four bytes, colour premultiplied as it is encoded. Of opaque pictures squares are
// added up, which is close to the light that sRGB stands for; of others what is there, as programs
// that lay one picture over another do. A picture is its own mean, to the bit.
class Mean {
 public:
  void begin(bool opaque);
  void add(const std::vector<std::uint8_t>& rgba);
  void take(std::vector<std::uint8_t>& rgba) const;  // at least one must have been added

 private:
  bool opaque_ = true;
  std::vector<std::uint32_t> sums_;
  std::uint32_t count_ = 0;
};

}  // namespace render
