// Which frames: A:B:S as in Python, B exclusive; a single number is that frame alone.
#include "app/run/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "scenes/read/input_error.h"

namespace app {

namespace {

[[noreturn]] void fail(const std::string& text, const std::string& reason) {
  throw scenes::InputError(fmt::format("--frames {}: {}", text, reason));
}

std::optional<int> parsePart(const std::string& text, const std::string& part) {
  if (part.empty()) return std::nullopt;
  int value = 0;
  const char* const end = part.data() + part.size();
  const auto [stop, error] = std::from_chars(part.data(), end, value);
  if (error != std::errc() || stop != end) {
    fail(text, fmt::format("'{}' is not a whole number; expected A:B:S, as 0:120:2", part));
  }
  return value;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

int fromEnd(int frame, int count) { return frame < 0 ? frame + count : frame; }

}  // namespace

std::vector<int> parseFrameRange(const std::string& text, int count) {
  const std::vector<std::string> parts = split(text);
  if (text.empty() || parts.size() > 3) fail(text, "expected A:B:S, as 0:120:2");
  const std::optional<int> first = parsePart(text, parts[0]);
  if (parts.size() == 1) {
    const int only = fromEnd(*first, count);
    if (only < 0 || only >= count)
      fail(text, fmt::format("the scene has frames 0 to {}", count - 1));
    return {only};
  }
  const std::optional<int> last = parsePart(text, parts[1]);
  const int step = parts.size() == 3 ? parsePart(text, parts[2]).value_or(1) : 1;
  if (step < 1) fail(text, fmt::format("a step of {} leads nowhere; expected 1 or more", step));

  const int low = std::max(0, fromEnd(first.value_or(0), count));
  const int high = std::min(count, fromEnd(last.value_or(count), count));
  std::vector<int> frames;
  for (std::int64_t frame = low; frame < high; frame += step)
    frames.push_back(static_cast<int>(frame));
  if (frames.empty()) fail(text, fmt::format("no frame left; the scene has 0 to {}", count - 1));
  return frames;
}

std::string frameRangeText(const std::vector<int>& frames) {
  if (frames.size() == 1) return fmt::format("{}", frames[0]);
  const int step = frames[1] - frames[0];
  const std::string range = fmt::format("{}:{}", frames.front(), frames.back() + 1);
  return step == 1 ? range : fmt::format("{}:{}", range, step);
}

}  // namespace app
