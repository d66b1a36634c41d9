// Letters beyond ASCII: in strings and comments as they are, refused at their place elsewhere and
// where they are no UTF-8.
#include <gtest/gtest.h>

#include "tests/scenes/scene_text.h"

namespace scenes {
namespace {

using namespace std::string_literals;

TEST(SceneLetters, AreReadInStringsAndComments) {
  const Scene scene = sceneOf("title = \"\u00dcbung \u02e2 \U0001f3b1\" # \u00e9\n" + ball("a"));
  EXPECT_EQ(scene.title, "\u00dcbung \u02e2 \U0001f3b1");
}

// toml++ 3.3 asks of each whether it is white space, and calls most answers unreachable.
TEST(SceneLetters, AreNoWhiteSpace) {
  const Scene scene =
      sceneOf("title = \"\"\"a \\\n  \u00e9t\u00e9 \u2c60 \u3001\"\"\"\n" + ball("a"));
  EXPECT_EQ(scene.title, "a \u00e9t\u00e9 \u2c60 \u3001");
  for (const char* letter : {"\u02e2", "\u00e9", "\u2c60", "\u3001", "\ufefd", "\U0001f3b1"}) {
    const std::string text = ball("a") + "position = [0, " + letter + " 0]\n";
    EXPECT_TRUE(errorOf(text).starts_with("test.toml:4:16: expected TOML")) << errorOf(text);
  }
}

TEST(SceneLetters, BytesThatAreNoUtf8AreRefusedAtTheirPlace) {
  EXPECT_EQ(errorOf("title = \"\u00e9\xff\"\n"),
            "test.toml:1:11: expected UTF-8, got the byte 0xff");
  EXPECT_EQ(errorOf("[[ball_socket]]\nattach = [ { node = [0, \xcb\xa2\xd3\xdf"),
            "test.toml:2:26: expected UTF-8, got the byte 0xd3");
  for (const std::string& bytes :
       {"\x80"s, "\xc0\xaf"s, "\xc3"s, "\xe0\x80\xaf"s, "\xed\xa0\x80"s, "\xf0\x80\x80\x80"s,
        "\xf4\x90\x80\x80"s, "\xf8\x88\x80\x80\x80"s, "\xe2\x82"s}) {
    EXPECT_TRUE(errorOf("# " + bytes).starts_with("test.toml:1:3: expected UTF-8")) << bytes;
    EXPECT_TRUE(
        errorOf("title = 1\n\"" + bytes + "\"").starts_with("test.toml:2:2: expected UTF-8"));
  }
}

TEST(SceneLetters, OverridesAreReadTheSameWay) {
  EXPECT_TRUE(errorOf(ball("a"), {"title=\"\xff\""}).starts_with("--set title="));
  EXPECT_EQ(sceneOf(ball("a"), {"title=\"\u00e9\""}).title, "\u00e9");
}

}  // namespace
}  // namespace scenes
