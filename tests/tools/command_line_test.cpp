// The command line: help, exit codes, errors before any work, and the figures of a small run.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class CommandLine : public ProgramTest {
 protected:
  void SetUp() override { write("mesh.off", kSmallOff); }

  // The subcommands that the help of the program lists.
  std::vector<std::string> subcommands() {
    const std::string help = reeb({}).output;
    std::vector<std::string> names;
    const std::regex line("\n  ([a-z]+) +[A-Z]");
    for (std::sregex_iterator it(help.begin(), help.end(), line), end; it != end; ++it) names.push_back((*it)[1]);
    return names;
  }
};

TEST_F(CommandLine, AloneItPrintsHelpWithThreeExamples) {
  const Outcome outcome = reeb({});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.error, "");
  EXPECT_GE(lines_after("  reeb ", outcome.output).size(), 3u) << outcome.output;
  EXPECT_LE(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 60) << "more than a page";
}

TEST_F(CommandLine, EverySubcommandHasHelpWithAnExample) {
  const auto names = subcommands();
  ASSERT_GE(names.size(), 6u);
  for (const std::string& name : names) {
    const Outcome outcome = reeb({name, "--help"});
    EXPECT_EQ(outcome.exit_code, 0) << name;
    EXPECT_NE(outcome.output.find("Example"), std::string::npos) << outcome.output;
    EXPECT_NE(outcome.output.find("reeb " + name), std::string::npos) << outcome.output;
  }
}

// The options that the string literals of a source name.
void collect_options(const std::string& source, std::set<std::string>& options) {
  const std::regex literal(R"re("(?:[^"\\\n]|\\.)*")re"), option("--[a-z][a-z-]*");
  for (std::sregex_iterator it(source.begin(), source.end(), literal), end; it != end; ++it) {
    const std::string text = it->str();
    for (std::sregex_iterator word(text.begin(), text.end(), option); word != end; ++word) options.insert(word->str());
  }
}

TEST_F(CommandLine, OptionsThatMessagesNameExist) {
  std::set<std::string> named, existing;
  for (const char* part : {"libreeb", "io", "ooc", "tools"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(REEB_SOURCE_DIR "/") + part))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".h")
        collect_options(read_file(entry.path()), named);
  ASSERT_GE(named.size(), 5u);
  std::string help = reeb({}).output;
  for (const std::string& name : subcommands()) help += reeb({name, "--help"}).output;
  const std::regex option("--[a-z][a-z-]*");
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) existing.insert(it->str());
  for (const std::string& name : named) EXPECT_TRUE(existing.contains(name)) << name << " is in a message only";
}

TEST_F(CommandLine, WhatItDoesNotKnowIsExitCode2) {
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"compute", "mesh.off", "-f", "height"},
                                             {"compute", "mesh.off", "-f", "random:"},
                                             {"compute", "mesh.off", "-f", "c"},
                                             {"compute", "mesh.off", "--fast"},
                                             {"compute", "mesh.off", "--threads", "0"},
                                             {"compute", "mesh.off", "--chunk", "many"},
                                             {"compute", "mesh.off", "--memory", "lots"},
                                             {"compute"},
                                             {"mesh.off", "--fast"},
                                             {"extract", "mesh.reeb", "--format", "jpeg"},
                                             {"extract", "mesh.reeb", "--nodes", "3", "--threshold", "1"},
                                             {"generate", "teapot", "-o", "teapot.ply"},
                                             {"pairs"},
                                             {"verify", "mesh.reeb", "more"}}) {
    expect_error(reeb(words), 2);
    EXPECT_EQ(files(), before) << last_command();
  }
}

TEST_F(CommandLine, AWordThatIsNoCommandNamesAMesh) {
  expect_success(reeb({"mesh.off"}));
  EXPECT_TRUE(std::filesystem::exists(in_folder("mesh.reeb")));
  expect_error(reeb({"comptue"}), 1, "comptue");
}

TEST_F(CommandLine, AnExistingOutputIsRefusedBeforeAnyWork) {
  write("mesh.reeb", "precious");
  expect_error(reeb({"compute", "mesh.off"}), 1, "mesh.reeb:");
  // The mesh is bad too, but is not read.
  write("bad.off", "OFF\n");
  expect_error(reeb({"compute", "bad.off", "-o", "mesh.reeb"}), 1, "mesh.reeb:");
  expect_error(reeb({"compute", "mesh.off", "-o", "new.reeb", "--report", "mesh.reeb"}), 1, "mesh.reeb:");
  EXPECT_EQ(file("mesh.reeb"), "precious");
  EXPECT_EQ(files(), (std::vector<std::string>{"bad.off", "mesh.off", "mesh.reeb"}));
  expect_success(reeb({"compute", "mesh.off", "--force"}));
  EXPECT_NE(file("mesh.reeb"), "precious");
  write("graph.rg", "precious");
  expect_error(reeb({"extract", "mesh.reeb", "-o", "graph.rg"}), 1, "graph.rg:");
  EXPECT_EQ(file("graph.rg"), "precious");
}

TEST_F(CommandLine, AnUnwritableFolderIsExitCode3) {
  write("file", "");
  for (const std::string folder : {"missing", "file"}) {
    expect_error(reeb({"compute", "mesh.off", "-o", folder + "/mesh.reeb"}), 3);
    expect_error(reeb({"compute", "mesh.off", "--temp-dir", folder}), 3);
    expect_success(reeb({"compute", "mesh.off", "-o", "good.reeb", "--force"}));
    expect_error(reeb({"extract", "good.reeb", "-o", folder + "/graph.rg"}), 3);
    expect_error(reeb({"generate", "torus", "--triangles", "100", "-o", folder + "/torus.ply"}), 3);
    EXPECT_EQ(files(), (std::vector<std::string>{"file", "good.reeb", "mesh.off"}));
  }
}

TEST_F(CommandLine, SeveralFunctionsHaveAnOutputEach) {
  expect_success(reeb({"compute", "mesh.off", "-o", "out.reeb", "-f", "x", "-f", "random:7"}));
  EXPECT_EQ(files(), (std::vector<std::string>{"mesh.off", "out-random-7.reeb", "out-x.reeb"}));
  expect_error(reeb({"compute", "mesh.off", "-o", "out.reeb", "-f", "y", "-f", "x"}), 1, "out-x.reeb:");
}

TEST_F(CommandLine, QuietSaysNothing) {
  const Outcome outcome = reeb({"compute", "mesh.off", "--quiet"});
  expect_success(outcome);
  EXPECT_EQ(outcome.output + outcome.error, "");
}

void expect_unsigned(const nlohmann::json& object, std::initializer_list<const char*> names) {
  for (const char* name : names) EXPECT_TRUE(object.at(name).is_number_unsigned()) << name;
}

void expect_report(const nlohmann::json& report) {
  EXPECT_EQ(report.at("schema"), "reeb.report.v1");
  for (const char* name : {"path", "format"}) EXPECT_TRUE(report.at("input").at(name).is_string()) << name;
  expect_unsigned(report.at("input"), {"vertices", "triangles", "bytes"});
  EXPECT_TRUE(report.at("function").at("name").is_string());
  for (const char* name : {"min", "max"}) EXPECT_TRUE(report.at("function").at(name).is_number()) << name;
  expect_unsigned(report.at("graph"), {"nodes", "arcs", "components", "loops"});
  expect_unsigned(report.at("pairs"), {"Ord0", "Rel1", "Ext0", "Ext1"});
  EXPECT_TRUE(report.at("denoised_pairs").is_number_integer());
  expect_unsigned(report, {"kept_loops", "peak_rss_bytes", "memory_budget_bytes", "spilled_bytes", "threads"});
  for (const char* name : {"wall", "finalization", "reorder", "reeb", "hierarchy"})
    EXPECT_TRUE(report.at("seconds").at(name).is_number_float()) << name;
  expect_unsigned(report.at("live_max"), {"vertices", "edges", "arcs"});
  EXPECT_TRUE(report.at("reordered").is_boolean());
  EXPECT_TRUE(report.at("output").is_string());
}

TEST_F(CommandLine, TheReportHasEveryField) {
  const Outcome one = reeb({"compute", "mesh.off", "--report", "-"});
  expect_success(one);
  const auto report = nlohmann::json::parse(one.output);
  expect_report(report);
  EXPECT_EQ(report.at("input").at("vertices"), 4);
  EXPECT_EQ(report.at("input").at("triangles"), 4);
  EXPECT_EQ(report.at("input").at("bytes"), file("mesh.off").size());
  EXPECT_EQ(report.at("output"), "mesh.reeb");
  expect_success(reeb({"compute", "mesh.off", "-f", "x", "-f", "y", "--report", "report.json"}));
  const auto reports = nlohmann::json::parse(file("report.json"));
  ASSERT_EQ(reports.size(), 2u);
  for (const auto& each : reports) expect_report(each);
}

TEST_F(CommandLine, AnEmptyMeshHasAnEmptyGraph) {
  write("empty.off", "OFF\n0 0 0\n");
  const Outcome outcome = reeb({"compute", "empty.off", "--report", "-"});
  expect_success(outcome);
  expect_report(nlohmann::json::parse(outcome.output));
  EXPECT_EQ(lines_after("n ", reeb({"extract", "empty.reeb"}).output).size(), 0u);
  expect_success(reeb({"verify", "empty.reeb"}));
}

TEST_F(CommandLine, AnUnreferencedVertexIsSaid) {
  write("loose.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
  const Outcome outcome = reeb({"compute", "loose.off"});
  expect_success(outcome);
  EXPECT_EQ(lines_after("note: 1 ", outcome.error).size(), 1u) << outcome.error;
}

TEST_F(CommandLine, AGraphOnlyFileHasNoPairs) {
  expect_success(reeb({"compute", "mesh.off", "--graph-only"}));
  expect_success(reeb({"extract", "mesh.reeb"}));
  expect_success(reeb({"verify", "mesh.reeb"}));
  expect_success(reeb({"info", "mesh.reeb", "--json"}));
  expect_error(reeb({"pairs", "mesh.reeb"}), 1, "mesh.reeb");
}

TEST_F(CommandLine, ASmallMeshNeedsLittle) {
  expect_success(reeb({"generate", "torus", "--triangles", "1000", "-o", "torus.ply"}));
  double seconds = 1e9;
  std::uint64_t peak = 0;
  for (int i = 0; i < 5; ++i) {
    const Outcome outcome = reeb({"compute", "torus.ply", "--force"});
    expect_success(outcome);
    seconds = std::min(seconds, outcome.seconds);
    peak = std::max(peak, outcome.peak_rss_bytes);
  }
  std::cout << "1,000 triangles: " << 1000 * seconds << " ms, " << peak << " bytes\n";
  if (!kSanitized) {
    EXPECT_LE(peak, 12u << 20);
  }
}

}  // namespace
}  // namespace reeb::test
