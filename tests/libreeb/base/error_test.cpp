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

TEST(Error, KeepsItsCauseWithAnotherHint) {
  EXPECT_EQ(broken().cause(), ErrorCause::kNone);
  const Error error = broken().at("a.ply", "12").because(ErrorCause::kMissing).with_hint("make it");
  EXPECT_EQ(error.cause(), ErrorCause::kMissing);
  EXPECT_EQ(error.hint(), "make it");
  EXPECT_STREQ(error.what(), "a.ply:12: it is broken");
}

// A class of its own for each cause would be lost where a place is added.
TEST(Error, KeepsItsCauseWithAPlace) {
  const auto caught = [](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      return error;
    }
    return broken();
  };
  const Error changed = caught([] { throw input_changed("it changed").at("a.ply", "12"); });
  EXPECT_EQ(changed.cause(), ErrorCause::kChanged);
  EXPECT_EQ(changed.kind(), ErrorKind::kBadInput);
  EXPECT_STREQ(changed.what(), "a.ply:12: it changed");
  const Error third = caught([] { throw not_manifold(9, 4).at("a.ply"); });
  EXPECT_EQ(third.cause(), ErrorCause::kNotManifold);
  EXPECT_STREQ(third.what(), "a.ply: the edge between vertices 4 and 9 has a third triangle");
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
