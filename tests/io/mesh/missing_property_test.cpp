// The hint names the properties that there are, but never so many that nobody reads them.
#include "io/mesh/missing_property.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace reeb::io {
namespace {

TEST(MissingProperty, SaysWhichThereAre) {
  const std::vector<std::string> known = {"heat", "velocity:0"};
  const Error error = missing_property("hot", known);
  EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
  EXPECT_EQ(error.message(), "the mesh has no vertex property \"hot\"");
  EXPECT_EQ(error.hint(), "it has these: heat, velocity:0");
  EXPECT_EQ(missing_property("hot", {}).hint(), "it has none but its coordinates");
}

TEST(MissingProperty, NamesAtMostTwenty) {
  const std::vector<std::string> twenty(20, "a");
  EXPECT_EQ(missing_property("b", twenty).hint().find("more"), std::string::npos);
  const std::vector<std::string> many(123, "a");
  EXPECT_TRUE(missing_property("b", many).hint().ends_with("a, a, and 103 more"));
}

}  // namespace
}  // namespace reeb::io
