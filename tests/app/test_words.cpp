// `dbd words` as a user asks it: everything, one table, or JSON.
#include "program.h"

namespace tests {
namespace {

class Words : public Program {};

TEST_F(Words, ListsEveryTable) {
  const Outcome all = run("words");
  ASSERT_EQ(all.code, 0) << all.errors;
  for (const char* told : {"[[body]]", "[[orientation_lock]]", "[simulation]", "{ shape.point }"}) {
    EXPECT_NE(all.output.find(told), std::string::npos) << told;
  }
}

TEST_F(Words, ListsOneTableAndThoseInIt) {
  const Outcome shapes = run("words shape");
  EXPECT_NE(shapes.output.find("{ shape.sphere }\n  radius "), std::string::npos) << shapes.output;
  EXPECT_EQ(shapes.output.find("[[body]]"), std::string::npos);
  const Outcome gravity = run("words gravity");
  EXPECT_NE(gravity.output.find("acceleration             m/s^2"), std::string::npos);
  EXPECT_NE(gravity.output.find("[x, y, z]; else [0, -9.81, 0]"), std::string::npos)
      << gravity.output;
  EXPECT_NE(run("words gravity --json").output.find("\"default\": \"[0, -9.81, 0]\""),
            std::string::npos);
}

TEST_F(Words, NamesTheNearestTableForAnUnknownOne) {
  const Outcome near = run("words bdoy");
  EXPECT_EQ(near.code, 2);
  EXPECT_EQ(near.errors, "dbd: words: no table 'bdoy'; did you mean 'body'?\n");
  EXPECT_EQ(run("words", "DBD_HOME=/no/such/folder").code, 2);
}

}  // namespace
}  // namespace tests
