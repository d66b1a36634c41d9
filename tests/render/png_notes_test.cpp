// What a PNG tells of itself stands in chunks that other programs read.
#include "render/png_notes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "folder.h"

namespace render {
namespace {

using PngNotesFile = TestFolder;

const Image kGrey{2, 1, std::vector<std::uint8_t>(6, 128)};

std::string allBytesOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(PngNotesFile, StandBehindTheHeadAndLeaveThePixels) {
  const PngNotes notes{{{"Title", "A ball"}, {"Frame", "17"}}, 0.0};
  writePng(kGrey, folder / "plain.png");
  writePng(kGrey, folder / "noted.png", notes);
  const std::string plain = allBytesOf(folder / "plain.png"),
                    noted = allBytesOf(folder / "noted.png");
  EXPECT_EQ(noted, plain.substr(0, 33) + noteChunks(notes, 2) + plain.substr(33));
  EXPECT_EQ(readPng(folder / "noted.png"), kGrey);
}

TEST(PngNotes, ArePlainTextOrUtf8) {
  using namespace std::string_literals;
  // length 7, its name, keyword, zero, text; the checksum of zlib.crc32(b"tEXtTitle\0x").
  EXPECT_EQ(noteChunks({{{"Title", "x"}}, 0}, 1).substr(0, 15), "\0\0\0\7tEXtTitle\0x"s);
  EXPECT_EQ(noteChunks({{{"Title", "x"}}, 0}, 1).substr(15), ")~M:"s);
  EXPECT_EQ(noteChunks({{{"T", "\xc3\xa4"}}, 0}, 1).substr(4, 12), "iTXtT\0\0\0\0\0\xc3\xa4"s);
}

// 1000 pixels on 10 cm are 10,000 a metre.
TEST(PngNotes, TellHowWideThePictureIsPrinted) {
  using namespace std::string_literals;
  const std::string chunk = noteChunks({{}, 0.1}, 1000);
  EXPECT_EQ(chunk.substr(0, 17), "\0\0\0\x09pHYs\0\0\x27\x10\0\0\x27\x10\1"s);
}

TEST(PngNotes, RefuseWhatIsNoKeyword) {
  for (const std::string& word : {std::string(), std::string(80, 'x'), std::string(" x"),
                                  std::string("a\nb"), std::string("\xc3\xa4")}) {
    EXPECT_THROW(noteChunks({{{word, "text"}}, 0}, 1), std::invalid_argument) << word;
  }
}

}  // namespace
}  // namespace render
