// Reads --size and --quality.
#include "app/commands/picture_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "app/commands/exit_code.h"
#include "app/run/run_record.h"
#include "render/film.h"

namespace app {

namespace {

constexpr int kLeastSide = 16, kMostSide = 8192;  // pixels

render::RendererOptions ofQuality(const std::string& name) {
  switch (name.empty() ? render::Quality::kStandard : parseQuality(name)) {
    case render::Quality::kDraft:
      return {640, 360, render::Quality::kDraft, ""};
    case render::Quality::kPaper:
      return {1920, 1080, render::Quality::kPaper, ""};
    case render::Quality::kStandard:
      break;
  }
  return {1280, 720, render::Quality::kStandard, ""};
}

}  // namespace

PictureSize parseSize(const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto parse = [&text](const char* begin, const char* end) {
    int side = 0;
    const auto [stop, error] = std::from_chars(begin, end, side);
    if (error != std::errc() || stop != end || side < kLeastSide || side > kMostSide) {
      throw scenes::InputError(fmt::format(
          "--size {}: expected WxH, each from {} to {}, as 1280x720", text, kLeastSide, kMostSide));
    }
    return side;
  };
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* const middle = cross == std::string::npos ? end : begin + cross;
  return {parse(begin, middle), parse(middle == end ? end : middle + 1, end)};
}

render::RendererOptions PictureOptions::renderer() const {
  render::RendererOptions options = ofQuality(quality);
  if (!size.empty()) {
    const PictureSize asked = parseSize(size);
    options.width = asked.width;
    options.height = asked.height;
  }
  return options;
}

void addPictureOptions(CLI::App& command, PictureOptions& options) {
  command.add_option("--size", options.size, "Pixels [640x360, 1280x720, 1920x1080 by quality]")
      ->type_name("WxH");
  command.add_option("--quality", options.quality, "Effort of drawing [standard]")
      ->type_name("draft|standard|paper");
}

void requireFfmpeg(const std::string& option) {
  if (!render::ffmpegVersion().empty()) return;
  throw EnvironmentError(option +
                         ": cannot run ffmpeg; install it with: sudo apt-get install -y ffmpeg");
}

}  // namespace app
