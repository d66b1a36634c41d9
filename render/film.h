// PNG frames to an H.264 film, by the ffmpeg program.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace render {

// The film could not be made; the message says why and what to do.
struct FilmError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct FilmOptions {
  int framesPerSecond = 60;
  int quality = 18;  // constant rate factor of x264: 0 lossless ... 51 worst
  std::vector<std::array<std::string, 2>> notes;       // keyword and text: title, comment
  std::string ffmpeg = "ffmpeg", ffprobe = "ffprobe";  // names on PATH, or paths
};

struct FilmReport {
  int frames = 0;
  int width = 0, height = 0;  // of the film: padded to even
  std::uintmax_t bytes = 0;
};

// The files DIR/00000.png ... by number, from first to last. Throws FilmError that names the
// first one that is missing.
std::vector<std::filesystem::path> frameFiles(const std::filesystem::path& folder, int first,
                                              int last, int step = 1);

// Every frame must be a PNG of the same size. The film is written under a temporary name, its
// frames are counted, and then it takes its name; after an error nothing is left.
FilmReport makeFilm(const std::vector<std::filesystem::path>& frames,
                    const std::filesystem::path& film, const FilmOptions& options = {});

// The first line that `ffmpeg -version` prints, or empty when it cannot be run.
std::string ffmpegVersion(const FilmOptions& options = {});

}  // namespace render
