// PNG files: written fast, whole or not at all, and the same bytes for the same image.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "render/image.h"

namespace render {

// What a file tells of itself beside the pixels.
struct PngNotes {
  std::vector<std::array<std::string, 2>> texts;  // keyword of 1 to 79 letters, UTF-8
  double printedWidth = 0;                        // m; 0: not told
};

// Writes under a temporary name in the same folder and renames. Throws std::system_error that names
// the file when that fails, and leaves nothing behind. std::invalid_argument when the image's size
// and its bytes disagree, or a keyword is none.
void writePng(const Image& image, const std::filesystem::path& file, const PngNotes& notes = {});

// Any PNG, as 8-bit RGB, and alpha where it has some. Throws std::system_error when the file cannot
// be opened and std::runtime_error when it is not a PNG.
Image readPng(const std::filesystem::path& file);

}  // namespace render
