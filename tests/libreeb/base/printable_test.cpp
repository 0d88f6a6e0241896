// What may be shown of foreign text: UTF-8 without control characters (RFC 3629).
#include "libreeb/base/printable.h"

#include <gtest/gtest.h>

#include <string>

#include "libreeb/base/error.h"

namespace reeb {
namespace {

TEST(Printable, KeepsCharactersOfEveryLength) {
  for (const char* text : {"", "scan.ply", "a b\\c", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x99\x82", "\xed\x9f\xbf",
                           "\xf4\x8f\xbf\xbf", "\xc2\xa0"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesControlCharacters) {
  EXPECT_EQ(printable("a\nb\tc\x1b[31m\x7f"), "a\\x0ab\\x09c\\x1b[31m\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b") << "the control sequence introducer";
}

// Cut characters, overlong ones, surrogates, and what lies beyond Unicode.
TEST(Printable, EscapesWhatIsNotUtf8) {
  EXPECT_EQ(printable("\xff"), "\\xff");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(printable("\xe2\x82z"), "\\xe2\\x82z");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");
  EXPECT_EQ(printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable("\x80"), "\\x80");
}

TEST(Printable, IsWhatAnErrorShows) {
  Error error(ErrorKind::kBadInput, std::string("\"\0\" is no number", 16), "hint");
  error.at("a\nb", "1:2");
  EXPECT_STREQ(error.what(), "a\\x0ab:1:2: \"\\x00\" is no number");
}

}  // namespace
}  // namespace reeb
