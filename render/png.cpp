// stb's PNG code, compiled here so that libdeflate can take the place of its own compressor.
#include "render/png.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "render/file_bytes.h"
#include "render/png_notes.h"
#include "render/unfinished.h"

namespace {

constexpr int kLevel = 1;  // half of stb's time is its own compressor; 1 is also smaller than that
// Each row less the one above it. One filter for all rows: trying all five costs more than it
// saves, and Paeth's, for files a tenth smaller, a quarter of the time.
constexpr int kUpFilter = 2;

// What stb calls instead of its own compressor; frees with STBIW_FREE.
unsigned char* deflateForStb(unsigned char* data, int size, int* compressedSize, int) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  if (!compressor) return nullptr;
  const auto bytes = static_cast<std::size_t>(size);
  const std::size_t room = libdeflate_zlib_compress_bound(compressor.get(), bytes);
  auto* const out = static_cast<unsigned char*>(std::malloc(room));
  if (out == nullptr) return nullptr;
  const std::size_t used = libdeflate_zlib_compress(compressor.get(), data, bytes, out, room);
  *compressedSize = static_cast<int>(used);
  return out;
}

}  // namespace

#define STBIW_ZLIB_COMPRESS deflateForStb
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb_image.h>
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace render {
namespace {

[[noreturn]] void fail(int error, const char* what, const std::filesystem::path& file) {
  throw std::system_error(error, std::generic_category(),
                          fmt::format("{} {}", what, file.string()));
}

struct Descriptor {
  int number = -1;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

void writeAll(int descriptor, const unsigned char* data, std::size_t size,
              const std::filesystem::path& file) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : EIO, "cannot write", file);
    data += written;
    size -= static_cast<std::size_t>(written);
  }
}

constexpr std::size_t kHead = 33;  // the signature and IHDR, which come first

void writeAndRename(const unsigned char* data, std::size_t size, const std::string& notes,
                    const std::filesystem::path& file) {
  UnfinishedFile unfinished(file);
  Descriptor out{::open(unfinished.part().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
  if (out.number < 0) fail(errno, "cannot create", file);
  writeAll(out.number, data, kHead, file);
  writeAll(out.number, reinterpret_cast<const unsigned char*>(notes.data()), notes.size(), file);
  writeAll(out.number, data + kHead, size - kHead, file);
  if (::close(std::exchange(out.number, -1)) != 0) fail(errno, "cannot write", file);
  unfinished.finish();
}

std::vector<std::uint8_t> interleaved(const Image& image) {
  std::vector<std::uint8_t> rgba;
  rgba.reserve(4 * image.alpha.size());
  for (std::size_t i = 0; i < image.alpha.size(); ++i) {
    rgba.insert(rgba.end(),
                {image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2], image.alpha[i]});
  }
  return rgba;
}

}  // namespace

void writePng(const Image& image, const std::filesystem::path& file, const PngNotes& notes) {
  const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  const bool sized =
      image.rgb.size() == 3 * size && (image.alpha.empty() || image.alpha.size() == size);
  if (image.width < 1 || image.height < 1 || !sized)
    throw std::invalid_argument(
        fmt::format("image: {} bytes for {} x {}", image.rgb.size(), image.width, image.height));
  const std::string chunks = noteChunks(notes, image.width);
  // Set once: stb reads it as a global, and it is the same for every thread.
  static const bool forced = (stbi_write_force_png_filter = kUpFilter, true);
  (void)forced;
  const std::vector<std::uint8_t> rgba = image.alpha.empty() ? image.alpha : interleaved(image);
  const int channels = rgba.empty() ? 3 : 4;
  int length = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(
      stbi_write_png_to_mem(rgba.empty() ? image.rgb.data() : rgba.data(), channels * image.width,
                            image.width, image.height, channels, &length),
      std::free);
  if (!bytes) fail(ENOMEM, "cannot compress", file);
  writeAndRename(bytes.get(), static_cast<std::size_t>(length), chunks, file);
}

Image readPng(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) fail(errno != 0 ? errno : ENOENT, "cannot open", file);
  const std::string bytes = bytesOf(stream);
  Image image;
  int channels = 0;
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const auto length = static_cast<int>(bytes.size());
  const bool known =
      stbi_info_from_memory(data, length, &image.width, &image.height, &channels) != 0;
  const int wanted = known && channels % 2 == 0 ? 4 : 3;  // grey and colour, with alpha
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, length, &image.width, &image.height, nullptr, wanted), std::free);
  if (!pixels)
    throw std::runtime_error(
        fmt::format("not a readable PNG: {} ({})", file.string(), stbi_failure_reason()));
  const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (wanted == 3) {
    image.rgb.assign(pixels.get(), pixels.get() + 3 * size);
    return image;
  }
  for (const stbi_uc* at = pixels.get(); at != pixels.get() + 4 * size; at += 4) {
    image.rgb.insert(image.rgb.end(), at, at + 3);
    image.alpha.push_back(at[3]);
  }
  return image;
}

}  // namespace render
