// The location that an error names, and the form of its text.
#include "libreeb/base/error.h"

#include <gtest/gtest.h>

#include <string>

namespace reeb {
namespace {

Error broken() { return {ErrorKind::kBadInput, "it is broken", "fix it"}; }

TEST(Error, SaysWhatIsKnownOfThePlace) {
  EXPECT_STREQ(broken().what(), "it is broken");
  EXPECT_STREQ(broken().at("a.ply").what(), "a.ply: it is broken");
  EXPECT_STREQ(broken().at("a.ply", "12").what(), "a.ply:12: it is broken");
  EXPECT_STREQ(broken().at("", "3:4").what(), "3:4: it is broken");
  EXPECT_STREQ(broken().at("").what(), "it is broken");
}

TEST(Error, KeepsThePlaceThatWasSaidFirst) {
  Error error = broken();
  error.at("", "12").at("a.ply", "13").at("b.ply", "14");
  EXPECT_EQ(error.file(), "a.ply");
  EXPECT_EQ(error.position(), "12");
  EXPECT_STREQ(error.what(), "a.ply:12: it is broken");
}

TEST(Error, KeepsItsParts) {
  const Error error = broken().at("a.ply", "12");
  EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
  EXPECT_EQ(error.message(), "it is broken");
  EXPECT_EQ(error.hint(), "fix it");
}

TEST(Error, CanBeGivenAPlaceOnItsWayOut) {
  try {
    try {
      throw broken();
    } catch (Error& error) {
      error.at("a.ply");
      throw;
    }
  } catch (const std::exception& error) {
    EXPECT_EQ(std::string(error.what()), "a.ply: it is broken");
  }
}

}  // namespace
}  // namespace reeb
