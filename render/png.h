// PNG files: written fast, whole or not at all, and the same bytes for the same image.
#pragma once

#include <filesystem>

#include "render/image.h"

namespace render {

// Writes under a temporary name in the same folder and renames. Throws std::system_error that names
// the file when that fails, and leaves nothing behind. std::invalid_argument when the image's size
// and its bytes disagree.
void writePng(const Image& image, const std::filesystem::path& file);

// Any PNG, as 8-bit RGB; alpha is dropped. Throws std::system_error when the file cannot be opened
// and std::runtime_error when it is not a PNG.
Image readPng(const std::filesystem::path& file);

}  // namespace render
