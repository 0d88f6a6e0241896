// Every test that docs/RELIABILITY.md names exists.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>

#include "tests/support/files.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;

TEST(ReliabilityDocument, NamesTestsThatExist) {
  const fs::path root = REEB_SOURCE_DIR;
  std::string all;
  for (const auto& entry : fs::recursive_directory_iterator(root / "tests"))
    if (entry.path().extension() == ".cpp") all += read_file(entry.path());
  const std::string text = read_file(root / "docs/RELIABILITY.md") + "\n";
  const std::regex quoted("`(?:([a-z_]+_test): )?([A-Z][A-Za-z]+)\\.([A-Z][A-Za-z0-9]+)`");
  int named = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), quoted), end; it != end; ++it, ++named) {
    const std::string test = std::string("(").append((*it)[2].str()).append(", ").append((*it)[3].str()).append(") {");
    EXPECT_NE(all.find(test), std::string::npos) << it->str();
  }
  EXPECT_GT(named, 30);
}

}  // namespace
}  // namespace reeb::test
