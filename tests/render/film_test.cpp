// Films have every frame that went in, or are not made.
#include "render/film.h"

#include <gtest/gtest.h>

#include <fstream>

#include "folder.h"
#include "render/child.h"
#include "render/image.h"
#include "render/png.h"

namespace render {
namespace {

namespace fs = std::filesystem;

class Film : public TestFolder {
 protected:
  void writeFrames(int count, int width, int height, int step = 1) {
    fs::create_directory(folder / "frames");
    for (int i = 0; i < count; ++i) {
      Image image{width, height, {}};
      image.rgb.assign(static_cast<std::size_t>(3 * width * height),
                       static_cast<std::uint8_t>(20 * i));
      char name[16];
      std::snprintf(name, sizeof name, "%05d.png", i * step);
      writePng(image, folder / "frames" / name);
    }
  }
  std::string probe(const char* entries) {
    return runChild({"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries", entries,
                     "-of", "csv=p=0", (folder / "film.mp4").string()})
        .output;
  }
  std::string messageOf(const FilmOptions& options, const std::vector<fs::path>& frames) {
    try {
      makeFilm(frames, folder / "film.mp4", options);
    } catch (const FilmError& error) {
      return error.what();
    }
    return "made";
  }
  bool available() const { return !ffmpegVersion().empty(); }
};

TEST_F(Film, HasEveryFrameEvenSizesAndTheColourTags) {
  if (!available()) GTEST_SKIP() << "no ffmpeg";
  writeFrames(7, 65, 33);
  const FilmReport report = makeFilm(frameFiles(folder / "frames", 0, 6), folder / "film.mp4");
  EXPECT_EQ(report.frames, 7);
  EXPECT_EQ(report.width, 66);
  EXPECT_EQ(report.height, 34);
  EXPECT_EQ(report.bytes, fs::file_size(folder / "film.mp4"));
  EXPECT_EQ(probe("stream=width,height,pix_fmt,color_space,color_transfer,color_primaries,"
                  "r_frame_rate"),
            "66,34,yuv420p,bt709,bt709,bt709,60/1\n");
  EXPECT_EQ(filesIn(), 2u);
}

TEST_F(Film, TakesFramesInSteps) {
  if (!available()) GTEST_SKIP() << "no ffmpeg";
  writeFrames(4, 64, 32, 10);
  const auto frames = frameFiles(folder / "frames", 0, 30, 10);
  EXPECT_EQ(makeFilm(frames, folder / "film.mp4").frames, 4);
}

TEST_F(Film, NamesTheFrameThatIsMissing) {
  writeFrames(5, 64, 32);
  fs::remove(folder / "frames" / "00003.png");
  try {
    frameFiles(folder / "frames", 0, 4);
    FAIL() << "must throw";
  } catch (const FilmError& error) {
    EXPECT_NE(std::string(error.what()).find("00003.png"), std::string::npos);
  }
}

TEST_F(Film, RefusesFramesOfAnotherSizeAndFilesThatAreNoPng) {
  writeFrames(2, 64, 32);
  auto frames = frameFiles(folder / "frames", 0, 1);
  writePng(Image{2, 2, std::vector<std::uint8_t>(12)}, frames[1]);
  EXPECT_NE(messageOf({}, frames).find("2 x 2"), std::string::npos);
  std::ofstream(frames[1]) << "text";
  EXPECT_NE(messageOf({}, frames).find("not a PNG"), std::string::npos);
  EXPECT_NE(messageOf({}, {}).find("no frames"), std::string::npos);
}

TEST_F(Film, SaysWhatToInstallWithoutFfmpeg) {
  writeFrames(2, 64, 32);
  FilmOptions options;
  options.ffmpeg = "no-such-ffmpeg";
  EXPECT_NE(messageOf(options, frameFiles(folder / "frames", 0, 1)).find("apt-get install ffmpeg"),
            std::string::npos);
  EXPECT_TRUE(ffmpegVersion(options).empty());
}

TEST_F(Film, LeavesNothingWhenTheEncoderFailsOrAFrameIsCut) {
  if (!available()) GTEST_SKIP() << "no ffmpeg";
  writeFrames(3, 64, 32);
  const auto frames = frameFiles(folder / "frames", 0, 2);
  FilmOptions failing;
  failing.ffmpeg = "false";
  EXPECT_NE(messageOf(failing, frames).find("failed"), std::string::npos);
  fs::resize_file(frames[1], 60);
  EXPECT_NE(messageOf({}, frames), "made");
  EXPECT_EQ(filesIn(), 1u);
}

TEST(Child, ThatClosesItsInputDoesNotEndUs) {
  const std::string much(1 << 20, 'a');
  const ChildResult result = runChild({"true"}, [&much](const Feed& feed) {
    while (feed(much.data(), much.size())) continue;
  });
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_FALSE(result.inputTaken);
}

TEST(Child, GetsItsInputAndReturnsWhatItPrints) {
  const auto write = [](const Feed& feed) { feed("to and fro", 10); };
  EXPECT_EQ(runChild({"cat"}, write).output, "to and fro");
  EXPECT_FALSE(runChild({"no-such-program"}).started);
}

}  // namespace
}  // namespace render
