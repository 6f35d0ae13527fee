// Texts from outside, as a terminal may have them.

#include "flute_grinder/base/escaped.h"

#include <gtest/gtest.h>

#include <string>

namespace grinder {
namespace test_escaped {

TEST(Escaped, LeavesWhatCanBeRead) {
  // The first and the last character of each length, without the controls.
  const std::string text = " ~\u00a0\u07ff\u0800\ud7ff\ue000\uffff\U00010000\U0010ffff \u00b5m \"quoted\" \\";
  EXPECT_EQ(escaped(text), text);
}

TEST(Escaped, ShowsWhatControlsATerminal) {
  EXPECT_EQ(escaped(std::string("a\x1b[2J\t\r\n\x7f\0", 10)), "a\\x1b[2J\\t\\r\\n\\x7f\\x00");
  EXPECT_EQ(escaped("\u009b2J"), "\\xc2\\x9b2J");
  EXPECT_EQ(escaped("a\n\tb", "\n"), "a\n\\tb");
}

TEST(Escaped, ShowsBytesThatAreNotUtf8) {
  EXPECT_EQ(escaped("\xff"), "\\xff");
  EXPECT_EQ(escaped("\xc3"), "\\xc3");                             // cut off
  EXPECT_EQ(escaped("\xc3("), "\\xc3(");                           // not followed by what belongs to it
  EXPECT_EQ(escaped("\xc1\xbf"), "\\xc1\\xbf");                    // longer than needed
  EXPECT_EQ(escaped("\xe0\x9f\xbf"), "\\xe0\\x9f\\xbf");           // the same
  EXPECT_EQ(escaped("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
  EXPECT_EQ(escaped("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond the last
}

}  // namespace test_escaped
}  // namespace grinder
