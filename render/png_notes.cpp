// Chunks by the PNG specification (W3C, third edition, 11.3): length, name, data, CRC of the last
// two.
#include "render/png_notes.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

namespace render {
namespace {

constexpr std::size_t kMostLetters = 79;  // of a keyword
constexpr char kPerMetre = 1;             // the unit of pHYs

std::string bigEndian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

std::string chunk(const std::string& name, const std::string& data) {
  const std::string body = name + data;
  return bigEndian(static_cast<std::uint32_t>(data.size())) + body +
         bigEndian(libdeflate_crc32(0, body.data(), body.size()));
}

bool isPlain(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return c == '\n' || (c >= 0x20 && c < 0x7f); });
}

std::string textChunk(const std::string& keyword, const std::string& text) {
  const bool isKeyword = !keyword.empty() && keyword.size() <= kMostLetters && isPlain(keyword) &&
                         keyword.front() != ' ' && keyword.back() != ' ' &&
                         keyword.find('\n') == std::string::npos;
  if (!isKeyword) throw std::invalid_argument("png: '" + keyword + "' is no keyword");
  if (isPlain(text)) return chunk("tEXt", keyword + '\0' + text);
  std::string known = text;  // a zero would end it
  std::replace(known.begin(), known.end(), '\0', ' ');
  // Not compressed, no language, no translated keyword.
  return chunk("iTXt", keyword + std::string(5, '\0') + known);
}

}  // namespace

std::string noteChunks(const PngNotes& notes, int width) {
  std::string chunks;
  if (notes.printedWidth > 0) {
    const auto perMetre =
        static_cast<std::uint32_t>(std::clamp(std::round(width / notes.printedWidth), 1.0, 1e9));
    chunks += chunk("pHYs", bigEndian(perMetre) + bigEndian(perMetre) + kPerMetre);
  }
  for (const auto& [keyword, text] : notes.texts) chunks += textChunk(keyword, text);
  return chunks;
}

}  // namespace render
