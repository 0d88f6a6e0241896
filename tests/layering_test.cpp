// The include rules between folders: tools, bench, tests -> io, ooc -> libreeb -> std.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"libreeb", {"libreeb"}},
    {"io", {"libreeb", "io"}},
    {"ooc", {"libreeb", "ooc"}},
};

// Quoted includes of a file that break the rule of its layer, and for libreeb every angle-bracket
// include that looks like a library (has a slash or an .h ending).
std::string first_violation(const fs::path& file, const std::string& layer) {
  std::ifstream in(file);
  static const std::regex kQuoted(R"re(^\s*#\s*include\s*"([^"/]+)/.*")re");
  static const std::regex kFlat(R"re(^\s*#\s*include\s*"[^"/]+")re");
  static const std::regex kAngled(R"re(^\s*#\s*include\s*<(.*[/.].*)>)re");
  for (std::string line; std::getline(in, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kQuoted) && !kMayInclude.at(layer).contains(match[1]))
      return file.string() + ": " + line;
    if (std::regex_search(line, kFlat)) return file.string() + ": not root-relative: " + line;
    if (layer == "libreeb" && std::regex_search(line, match, kAngled))
      return file.string() + ": beyond the standard library: " + line;
  }
  return {};
}

TEST(Layering, EveryIncludePointsDown) {
  std::size_t files = 0;
  for (const auto& [layer, allowed] : kMayInclude) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(REEB_SOURCE_DIR) / layer)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      EXPECT_EQ(first_violation(entry.path(), layer), "");
    }
  }
  EXPECT_GT(files, 10u) << "the source tree was not found";
}

TEST(Layering, AViolationIsSeen) {
  const fs::path bad = fs::temp_directory_path() / "reeb_layering_bad.h";
  std::ofstream(bad) << "#include \"ooc/pipeline.h\"\n";
  EXPECT_NE(first_violation(bad, "io"), "");
  std::ofstream(bad) << "#include <tbb/tbb.h>\n";
  EXPECT_NE(first_violation(bad, "libreeb"), "");
  fs::remove(bad);
}

}  // namespace
