// docs/CLI.md against the program: the same commands, options and JSON fields, no more and no fewer.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using Names = std::set<std::string>;

// The first group of all matches of `pattern`.
Names matches(const std::string& text, const std::string& pattern) {
  Names names;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) names.insert((*it)[1]);
  return names;
}

// The text after the heading, up to the next heading of the same or a higher level.
std::string section(const std::string& document, const std::string& heading) {
  const auto start = document.find("\n" + heading);
  if (start == std::string::npos) return {};
  const std::size_t level = heading.find_first_not_of('#');
  const std::regex next("\n#{1," + std::to_string(level) + "} ");
  std::smatch found;
  const std::string rest = document.substr(start + 1);
  return std::regex_search(rest, found, next) ? rest.substr(0, static_cast<std::size_t>(found.position())) : rest;
}

// What the text calls the schema of its JSON, in a table or in an example.
Names schemas(const std::string& text) {
  Names names = matches(text, "\n\\| `schema` \\| `([^`]+)`");
  names.merge(matches(text, "\"schema\": \"([^\"]+)\""));
  return names;
}

// The code spans in the first column of all tables.
Names first_column(const std::string& text) {
  Names names;
  const std::regex row("\n\\| ([^|]*)\\|");
  for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it) {
    const Names spans = matches((*it)[1], "`([^`]+)`");
    names.insert(spans.begin(), spans.end());
  }
  return names;
}

Names documented_options(const std::string& text) {
  Names options;
  for (const std::string& span : first_column(text))
    if (span.starts_with('-')) options.insert(span.substr(0, span.find(' ')));
  return options;
}

// The options at the beginning of the lines of a help: " -o,--output TEXT", " --force".
Names help_options(const std::string& help) {
  Names options = matches(help, "\n  (--[a-z][a-z-]*)");
  for (const char* part : {"\n  (-[a-z]),--[a-z]", "\n  -[a-z],(--[a-z][a-z-]*)"}) options.merge(matches(help, part));
  return options;
}

// Paths of all values that are not objects, such as "graph.nodes"; also inside nested objects and arrays of objects.
void collect_fields(const nlohmann::json& json, const std::string& path, Names& fields) {
  if (json.is_object()) {
    for (const auto& [name, value] : json.items())
      collect_fields(value, path.empty() ? name : path + "." + name, fields);
  } else if (json.is_array() && !json.empty() && json.front().is_object()) {
    collect_fields(json.front(), path, fields);
  } else {
    fields.insert(path);
  }
}

Names fields(const std::string& json) {
  Names names;
  collect_fields(nlohmann::json::parse(json), "", names);
  return names;
}

class CliDocument : public ProgramTest {
 protected:
  void SetUp() override {
    write("mesh.off", kSmallOff);
    document_ = read_file(REEB_SOURCE_DIR "/docs/CLI.md");
  }
  std::string help(const std::string& command) { return reeb({command, "--help"}).output; }
  std::string documented(const std::string& heading) const { return section(document_, heading); }

  std::string document_;
};

TEST_F(CliDocument, HasEveryCommand) {
  const Names commands = matches(reeb({}).output, "\n  ([a-z]+) +[A-Z]");
  EXPECT_GE(commands.size(), 7u);
  EXPECT_EQ(matches(document_, "\n## `reeb ([a-z]+)"), commands);
}

TEST_F(CliDocument, HasEveryOption) {
  for (const std::string& command : matches(reeb({}).output, "\n  ([a-z]+) +[A-Z]")) {
    const Names options = help_options(help(command));
    EXPECT_GE(options.size(), 3u) << command;
    EXPECT_EQ(documented_options(documented("## `reeb " + command)), options) << command;
  }
  // The options of the program itself are in prose.
  for (const std::string& option : help_options(reeb({}).output))
    EXPECT_NE(document_.find(option + '`'), std::string::npos) << option;
}

// Options in prose and in examples also exist.
TEST_F(CliDocument, NamesNoOtherOption) {
  Names options = help_options(reeb({}).output);
  for (const std::string& command : matches(reeb({}).output, "\n  ([a-z]+) +[A-Z]"))
    options.merge(help_options(help(command)));
  for (const std::string& option : matches(document_, "[^a-z-](--[a-z][a-z-]*)"))
    EXPECT_TRUE(options.contains(option)) << option;
}

TEST_F(CliDocument, HasEveryFieldOfTheReport) {
  const Outcome outcome = reeb({"compute", "mesh.off", "--report", "-"});
  expect_success(outcome);
  EXPECT_EQ(first_column(documented("### Fields of the report")), fields(outcome.output));
}

TEST_F(CliDocument, HasEveryFieldOfInfo) {
  expect_success(reeb({"compute", "mesh.off"}));
  // With a place of each kind, two triangles as one that is folded, and three at an edge.
  write("bad.off",
        "OFF\n8 8 0\n0 0 0\n1 0 0\n0 1 0\n0 1 0.01\n5 0 0\n6 0 0\n5 1 0\n5 0 1\n3 0 1 2\n3 1 0 3\n3 0 1 1\n"
        "3 4 5 6\n3 4 5 7\n3 4 5 0\n3 4 5 0\n3 2 2 3\n");
  expect_success(reeb({"fragment", "mesh.off", "--part", "1/2", "-o", "p.fragment"}));
  const std::map<std::string, std::string> tables = {{"mesh.reeb", "### Fields for a `.reeb` file"},
                                                     {"p.fragment", "### Fields for a fragment"},
                                                     {"bad.off", "### Fields for a mesh"}};
  for (const auto& [file, heading] : tables) {
    const Outcome outcome = reeb({"info", file, "--json"});
    expect_success(outcome);
    EXPECT_EQ(first_column(documented(heading)), fields(outcome.output)) << heading;
    EXPECT_EQ(schemas(documented(heading)),
              Names{nlohmann::json::parse(outcome.output).at("schema").get<std::string>()})
        << heading;
  }
}

TEST_F(CliDocument, HasEveryFieldOfAnImage) {
  write("v.nrrd", "NRRD0005\ntype: int\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n0\n1\n2\n3\n4\n5\n6\n7\n");
  const Outcome outcome = reeb({"info", "v.nrrd", "--json"});
  expect_success(outcome);
  Names expected;
  for (const std::string& field : fields(outcome.output))
    if (field.starts_with("grid.")) expected.insert(field.substr(5));
  // They are in prose.
  const std::string text = documented("### Fields for a mesh"), begin = "`grid`, with ";
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(matches(text.substr(at + begin.size()), "`([a-z_]+)`"), expected);
}

TEST_F(CliDocument, HasTheSchemasOfAllOutputs) {
  expect_success(reeb({"compute", "mesh.off", "--report", "report.json"}));
  expect_success(reeb({"extract", "mesh.reeb", "-o", "graph.json"}));
  expect_success(reeb({"pairs", "mesh.reeb", "-o", "pairs.json"}));
  expect_success(reeb({"defects", "mesh.off", "-o", "defects.json"}));
  expect_success(reeb({"repair", "mesh.off", "--all", "-o", "o.off", "--log", "log.json"}));
  const std::map<std::string, std::string> sections = {{"report.json", "### Fields of the report"},
                                                       {"graph.json", "## `reeb extract"},
                                                       {"pairs.json", "## `reeb pairs"},
                                                       {"defects.json", "## `reeb defects"},
                                                       {"log.json", "## `reeb repair"}};
  for (const auto& [name, heading] : sections)
    EXPECT_EQ(schemas(documented(heading)), Names{nlohmann::json::parse(file(name)).at("schema").get<std::string>()})
        << heading;
}

}  // namespace
}  // namespace reeb::test
