// Checks the frames, pipes them to ffmpeg, counts what came out.
#include "render/film.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "render/child.h"
#include "render/file_bytes.h"
#include "render/unfinished.h"

namespace render {
namespace {

namespace fs = std::filesystem;

struct Size {
  int width = 0, height = 0;
  bool operator==(const Size&) const = default;
};

// Width and height from a PNG's head: 8 bytes of signature, 8 of the chunk's head, then the two.
Size sizeOfPng(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FilmError(fmt::format("film: cannot read the frame {}", file.string()));
  std::array<unsigned char, 24> head{};
  stream.read(reinterpret_cast<char*>(head.data()), head.size());
  constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (!stream || !std::equal(kSignature.begin(), kSignature.end(), head.begin()))
    throw FilmError(fmt::format("film: not a PNG: {}", file.string()));
  const auto number = [&head](std::size_t at) {
    return head[at] << 24 | head[at + 1] << 16 | head[at + 2] << 8 | head[at + 3];
  };
  return {number(16), number(20)};
}

Size checkFrames(const std::vector<fs::path>& frames) {
  if (frames.empty()) throw FilmError("film: there are no frames");
  const Size size = sizeOfPng(frames.front());
  for (const fs::path& frame : frames)
    if (const Size other = sizeOfPng(frame); other != size)
      throw FilmError(fmt::format("film: {} is {} x {}, the first frame {} x {}", frame.string(),
                                  other.width, other.height, size.width, size.height));
  return size;
}

std::vector<std::string> encoderArguments(const FilmOptions& options, const fs::path& part) {
  std::vector<std::string> arguments = {options.ffmpeg,
                                        "-hide_banner",
                                        "-nostdin",
                                        "-y",
                                        "-loglevel",
                                        "error",
                                        "-f",
                                        "image2pipe",
                                        "-c:v",
                                        "png",
                                        "-framerate",
                                        std::to_string(options.framesPerSecond),
                                        "-i",
                                        "pipe:0",
                                        "-vf",
                                        "pad=ceil(iw/2)*2:ceil(ih/2)*2:0:0:white,"
                                        "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
                                        "-c:v",
                                        "libx264",
                                        "-preset",
                                        "medium",
                                        "-crf",
                                        std::to_string(options.quality),
                                        "-pix_fmt",
                                        "yuv420p",
                                        "-colorspace",
                                        "bt709",
                                        "-color_primaries",
                                        "bt709",
                                        "-color_trc",
                                        "bt709",
                                        "-color_range",
                                        "tv",
                                        "-movflags",
                                        "+faststart"};
  for (const auto& [keyword, text] : options.notes) {
    arguments.insert(arguments.end(), {"-metadata", keyword + "=" + text});
  }
  arguments.insert(arguments.end(), {"-f", "mp4", part.string()});
  return arguments;
}

void feedFrames(const std::vector<fs::path>& frames, const Feed& feed) {
  for (const fs::path& frame : frames) {
    std::ifstream stream(frame, std::ios::binary);
    const std::string bytes = bytesOf(stream);
    if (!stream || bytes.empty())
      throw FilmError(fmt::format("film: cannot read the frame {}", frame.string()));
    if (!feed(bytes.data(), bytes.size())) return;
  }
}

std::string shortened(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.size() > 600 ? fmt::format("...{}", text.substr(text.size() - 600)) : text;
}

[[noreturn]] void failMissing(const std::string& program) {
  throw FilmError(fmt::format(
      "film: cannot run '{}'; install it with: apt-get install ffmpeg (the frames are kept)",
      program));
}

void encode(const std::vector<fs::path>& frames, const fs::path& part, const FilmOptions& options) {
  const ChildResult result = runChild(encoderArguments(options, part),
                                      [&](const Feed& feed) { feedFrames(frames, feed); });
  if (!result.started) failMissing(options.ffmpeg);
  if (result.exitCode != 0 || !result.inputTaken)
    throw FilmError(fmt::format("film: ffmpeg failed with code {}: {}", result.exitCode,
                                shortened(result.errors)));
}

int countFrames(const fs::path& film, const FilmOptions& options) {
  const ChildResult result =
      runChild({options.ffprobe, "-v", "error", "-select_streams", "v:0", "-count_packets",
                "-show_entries", "stream=nb_read_packets", "-of", "csv=p=0", film.string()});
  if (!result.started) failMissing(options.ffprobe);
  try {
    return std::stoi(result.output);
  } catch (const std::exception&) {
    throw FilmError(
        fmt::format("film: ffprobe cannot read what ffmpeg wrote: {}", shortened(result.errors)));
  }
}

}  // namespace

std::vector<fs::path> frameFiles(const fs::path& folder, int first, int last, int step) {
  if (step < 1) throw FilmError("film: the step between frames must be at least 1");
  std::vector<fs::path> files;
  for (int frame = first; frame <= last; frame += step) {
    files.push_back(folder / fmt::format("{:05}.png", frame));
    std::error_code ignored;
    if (!fs::is_regular_file(files.back(), ignored))
      throw FilmError(
          fmt::format("film: frame {} is missing; render it first", files.back().string()));
  }
  return files;
}

FilmReport makeFilm(const std::vector<fs::path>& frames, const fs::path& film,
                    const FilmOptions& options) {
  if (options.framesPerSecond < 1) throw FilmError("film: at least one frame per second is needed");
  const Size size = checkFrames(frames);
  UnfinishedFile unfinished(film);
  encode(frames, unfinished.part(), options);
  const int counted = countFrames(unfinished.part(), options);
  if (counted != static_cast<int>(frames.size()))
    throw FilmError(fmt::format("film: {} frames went in and {} came out", frames.size(), counted));
  const FilmReport report{counted, size.width + size.width % 2, size.height + size.height % 2,
                          fs::file_size(unfinished.part())};
  try {
    unfinished.finish();
  } catch (const std::system_error& error) {
    throw FilmError(fmt::format("film: {}", error.what()));
  }
  return report;
}

std::string ffmpegVersion(const FilmOptions& options) {
  const ChildResult result = runChild({options.ffmpeg, "-version"});
  return result.started ? result.output.substr(0, result.output.find('\n')) : std::string();
}

}  // namespace render
