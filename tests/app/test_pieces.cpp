// The small parts of the program that are worth asking directly.
#include <gtest/gtest.h>

#include "app/base/html.h"
#include "app/base/nearest.h"
#include "app/base/numbers.h"
#include "app/run/frame_range.h"
#include "scenes/read/input_error.h"

namespace tests {
namespace {

using Frames = std::vector<int>;

TEST(FrameRange, FollowsPythonSlices) {
  EXPECT_EQ(app::parseFrameRange(":", 3), (Frames{0, 1, 2}));
  EXPECT_EQ(app::parseFrameRange("1:", 3), (Frames{1, 2}));
  EXPECT_EQ(app::parseFrameRange(":2", 3), (Frames{0, 1}));
  EXPECT_EQ(app::parseFrameRange("::2", 5), (Frames{0, 2, 4}));
  EXPECT_EQ(app::parseFrameRange("-2:", 5), (Frames{3, 4}));
  EXPECT_EQ(app::parseFrameRange(":-3", 5), (Frames{0, 1}));
  EXPECT_EQ(app::parseFrameRange("2:100", 4), (Frames{2, 3}));
  EXPECT_EQ(app::parseFrameRange("3", 4), (Frames{3}));
  EXPECT_EQ(app::parseFrameRange("-1", 4), (Frames{3}));
}

TEST(FrameRange, RefusesWhatLeavesNoFrame) {
  for (const char* text : {"", "4", "-5", "2:2", "3:1", "0:3:0", "0:3:-1", "a", "1.5:3", "1:2:3:4",
                           "99999999999:", "9:"}) {
    EXPECT_THROW(app::parseFrameRange(text, 4), scenes::InputError) << text;
  }
}

TEST(NearestWord, FindsMisspellingsAndNothingElse) {
  const std::vector<std::string> known = {"render", "simulate", "check"};
  EXPECT_EQ(app::nearestWord("rendr", known), "render");
  EXPECT_EQ(app::nearestWord("simualte", known), "simulate");
  EXPECT_EQ(app::nearestWord("xyzzyplugh", known), "");
}

TEST(Html, TextCannotBecomeMarkup) {
  EXPECT_EQ(app::escapeHtml("<a href=\"x\">&"), "&lt;a href=&quot;x&quot;&gt;&amp;");
}

}  // namespace

TEST(Numbers, PercentsHaveNoMinusZero) {
  EXPECT_EQ("0 %", app::wholePercentText(-0.004));
  EXPECT_EQ("-1 %", app::wholePercentText(-0.006));
  EXPECT_EQ("12 %", app::wholePercentText(0.12));
}

TEST(Numbers, LengthsHaveTheUnitThatFits) {
  EXPECT_EQ("3.2 mm", app::lengthText(0.0032));
  EXPECT_EQ("1.5 km", app::lengthText(1500));
  EXPECT_EQ("0 m", app::lengthText(0));
  EXPECT_EQ("9.6 µm", app::lengthText(9.6e-6));
  EXPECT_EQ("3.55 pm", app::lengthText(3.55e-12));
  EXPECT_EQ("120", app::textBeyond(120, 110));
  EXPECT_EQ("1.004", app::textBeyond(1.0044, 1));
}

}  // namespace tests
