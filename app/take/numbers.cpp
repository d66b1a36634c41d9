// Numbers of many frames in few bytes.
#include "app/take/numbers.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>

namespace app {

namespace {

constexpr float kSteps = 65535;
constexpr int kLevel = 9;  // of 12; the levels above it take ten times as long for 1 %

// A number as whole steps above the least.
struct Scale {
  float least = 0, step = 0;

  Scale() = default;
  Scale(float low, float high) : least(low), step((high - low) / kSteps) {}
  std::uint16_t stepsTo(float number) const {
    if (step <= 0) return 0;
    return static_cast<std::uint16_t>(
        std::lround(std::clamp((number - least) / step, 0.0f, kSteps)));
  }
};

// Small differences of either sign become small numbers; modulo 2^16.
std::uint16_t folded(std::uint16_t now, std::uint16_t before) {
  const auto difference = static_cast<std::int16_t>(static_cast<std::uint16_t>(now - before));
  const auto twice = static_cast<std::uint16_t>(2 * difference);
  return difference < 0 ? static_cast<std::uint16_t>(~twice) : twice;
}

using StrokeSteps = std::array<std::uint16_t, 6>;

StrokeSteps stepsOf(const TakeStroke& stroke, const std::array<Scale, 3>& scales) {
  StrokeSteps steps{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    steps[k] = scales[k].stepsTo(stroke.from[axis]);
    steps[k + 3] = static_cast<std::uint16_t>(scales[k].stepsTo(stroke.to[axis]) - steps[k]);
  }
  return steps;
}

std::array<Scale, 3> scalesOf(const TakeLayer& layer) {
  render::Vec3f low = render::Vec3f::Constant(1e30f), high = -low;
  for (const std::vector<TakeStroke>& frame : layer.frames) {
    for (const TakeStroke& stroke : frame) {
      low = low.cwiseMin(stroke.from).cwiseMin(stroke.to);
      high = high.cwiseMax(stroke.from).cwiseMax(stroke.to);
    }
  }
  return {Scale(low.x(), high.x()), Scale(low.y(), high.y()), Scale(low.z(), high.z())};
}

std::string base64(const std::string& bytes) {
  constexpr const char* kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int shift = 18; shift >= 0; shift -= 6) text += kLetters[three >> shift & 63];
  }
  const std::size_t over = bytes.size() % 3;
  if (over > 0) text.replace(text.size() - (3 - over), 3 - over, 3 - over, '=');
  return text;
}

}  // namespace

void TakeNumbers::addBytes(const void* bytes, std::size_t count) {
  bytes_.append(static_cast<const char*>(bytes), count);
  bytes_.resize((bytes_.size() + 3) / 4 * 4, '\0');
}

void TakeNumbers::add(const std::vector<float>& numbers) {
  addBytes(numbers.data(), numbers.size() * sizeof(float));
}

void TakeNumbers::add(const std::vector<std::uint32_t>& numbers) {
  addBytes(numbers.data(), numbers.size() * sizeof(std::uint32_t));
}

void TakeNumbers::addParted(const std::vector<std::uint16_t>& numbers) {
  std::string parts(2 * numbers.size(), '\0');
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    parts[i] = static_cast<char>(numbers[i] & 255);
    parts[numbers.size() + i] = static_cast<char>(numbers[i] >> 8);
  }
  addBytes(parts.data(), parts.size());
}

void TakeNumbers::addTracks(const std::vector<std::vector<float>>& rows) {
  const std::size_t columns = rows.front().size();
  std::vector<float> leasts, steps;
  std::vector<std::uint16_t> moving;
  for (std::size_t column = 0; column < columns; ++column) {
    float low = rows.front()[column], high = low;
    for (const std::vector<float>& row : rows) {
      low = std::min(low, row[column]);
      high = std::max(high, row[column]);
    }
    const Scale scale(low, high);
    leasts.push_back(scale.least);
    steps.push_back(scale.step);
    if (scale.step <= 0) continue;
    std::uint16_t before = 0;
    for (const std::vector<float>& row : rows) {
      const std::uint16_t now = scale.stepsTo(row[column]);
      moving.push_back(folded(now, before));
      before = now;
    }
  }
  add(leasts);
  add(steps);
  addParted(moving);
}

void TakeNumbers::addLayer(const TakeLayer& layer) {
  const std::array<Scale, 3> scales = scalesOf(layer);
  std::vector<std::uint32_t> counts;
  std::string styles;
  std::array<std::vector<std::uint16_t>, 6> columns;
  std::vector<StrokeSteps> before;
  for (const std::vector<TakeStroke>& frame : layer.frames) {
    counts.push_back(static_cast<std::uint32_t>(frame.size()));
    before.resize(std::max(before.size(), frame.size()), StrokeSteps{});
    for (std::size_t i = 0; i < frame.size(); ++i) {
      styles += static_cast<char>(frame[i].style);
      const StrokeSteps now = stepsOf(frame[i], scales);
      for (std::size_t k = 0; k < now.size(); ++k) {
        columns[k].push_back(folded(now[k], before[i][k]));
      }
      before[i] = now;
    }
  }
  add(counts);
  addBytes(styles.data(), styles.size());
  std::vector<float> scaling;
  for (const Scale& scale : scales) scaling.insert(scaling.end(), {scale.least, scale.step});
  add(scaling);
  for (const std::vector<std::uint16_t>& column : columns) addParted(column);
}

std::string TakeNumbers::packed() const {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string packed(libdeflate_deflate_compress_bound(compressor.get(), bytes_.size()), '\0');
  packed.resize(libdeflate_deflate_compress(compressor.get(), bytes_.data(), bytes_.size(),
                                            packed.data(), packed.size()));
  return base64(packed);
}

}  // namespace app
