// Sums, and what they come to.
#include "render/mean.h"

#include <cmath>

namespace render {

void Mean::begin(bool opaque) {
  opaque_ = opaque;
  count_ = 0;
}

void Mean::add(const std::vector<std::uint8_t>& rgba) {
  if (count_++ == 0) sums_.assign(rgba.size(), 0);
  const std::uint8_t* const from = rgba.data();
  std::uint32_t* const to = sums_.data();
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    const std::uint32_t value = from[i];
    to[i] += opaque_ ? value * value : value;
  }
}

void Mean::take(std::vector<std::uint8_t>& rgba) const {
  rgba.resize(sums_.size());
  const float share = 1.0f / static_cast<float>(count_);
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    const float mean = static_cast<float>(sums_[i]) * share;
    rgba[i] = static_cast<std::uint8_t>((opaque_ ? std::sqrt(mean) : mean) + 0.5f);
  }
}

}  // namespace render
