// PNG files arrive whole or not at all.
#include "render/png.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <system_error>

#include "folder.h"

namespace render {
namespace {

namespace fs = std::filesystem;
using Png = TestFolder;

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int i = 0; i < 3 * width * height; ++i)
    image.rgb.push_back(static_cast<std::uint8_t>(i * 7 + i / 31));
  return image;
}

std::string bytesOf(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(Png, ReadsBackWhatWasWritten) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {64, 40}}) {
    const Image image = gradient(width, height);
    writePng(image, folder / "a.png");
    EXPECT_EQ(readPng(folder / "a.png"), image);
  }
}

TEST_F(Png, GivesTheSameBytesForTheSameImage) {
  writePng(gradient(64, 40), folder / "a.png");
  writePng(gradient(64, 40), folder / "b.png");
  EXPECT_EQ(bytesOf(folder / "a.png"), bytesOf(folder / "b.png"));
  EXPECT_EQ(filesIn(), 2u);  // and leaves no temporary file
}

TEST_F(Png, ReplacesAFile) {
  writePng(gradient(8, 8), folder / "a.png");
  writePng(gradient(9, 9), folder / "a.png");
  EXPECT_EQ(readPng(folder / "a.png").width, 9);
}

TEST_F(Png, NamesTheFileInAFolderThatIsMissing) {
  try {
    writePng(gradient(8, 8), folder / "none" / "a.png");
    FAIL() << "must throw";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code().value(), ENOENT);
    EXPECT_NE(std::string(error.what()).find("none/a.png"), std::string::npos);
  }
}

TEST_F(Png, LeavesNothingBehindWhenTheNameIsTaken) {
  fs::create_directories(folder / "a.png" / "inside");
  EXPECT_THROW(writePng(gradient(8, 8), folder / "a.png"), std::system_error);
  EXPECT_EQ(filesIn(), 1u);
}

// A limit on the size of files stands in for a full disk: the write comes back short.
TEST_F(Png, LeavesNothingBehindWhenTheDiskIsFull) {
  writePng(gradient(8, 8), folder / "a.png");
  const Image before = readPng(folder / "a.png");
  rlimit old{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit tight{512, old.rlim_max};
  const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(writePng(gradient(200, 100), folder / "a.png"), std::system_error);
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, oldHandler);
  EXPECT_EQ(readPng(folder / "a.png"), before);
  EXPECT_EQ(filesIn(), 1u);
}

TEST_F(Png, RefusesAnImageWhoseBytesDoNotFitItsSize) {
  Image image = gradient(8, 8);
  image.rgb.pop_back();
  EXPECT_THROW(writePng(image, folder / "a.png"), std::invalid_argument);
}

TEST_F(Png, RefusesToReadWhatIsMissingOrNoPng) {
  EXPECT_THROW(readPng(folder / "none.png"), std::system_error);
  std::ofstream(folder / "text.png") << "no picture";
  EXPECT_THROW(readPng(folder / "text.png"), std::runtime_error);
}

}  // namespace
}  // namespace render
