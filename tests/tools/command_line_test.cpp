// The command line: help, exit codes, errors before any work, and the figures of a small run.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

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
  const std::regex literal(R"re("(?:[^"\\\n]|\\.)*")re"), option("(^|[^!])--[a-z][a-z-]*");  // no comment of HTML
  for (std::sregex_iterator it(source.begin(), source.end(), literal), end; it != end; ++it) {
    const std::string text = it->str();
    for (std::sregex_iterator word(text.begin(), text.end(), option); word != end; ++word)
      options.insert(word->str().substr(word->str().find("--")));
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

// An unset variable of a shell gives one.
TEST_F(CommandLine, AnEmptyValueIsExitCode2AndNamesTheOption) {
  expect_success(reeb({"compute", "mesh.off"}));
  const std::vector<std::string> before = files();
  const std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> commands = {
      {{"compute", "mesh.off", "--force"},
       {"--function", "--output", "--denoise", "--report", "--temp-dir", "--grid", "--type", "--spacing", "--memory"}},
      {{"extract", "mesh.reeb"}, {"--format", "--output", "--threshold"}},
      {{"plot", "mesh.reeb"}, {"--threshold", "--view", "--mesh", "--kind"}},
      {{"defects", "mesh.off"}, {"--below", "--longest", "--output", "--patches"}},
      {{"repair", "mesh.off", "-o", "r.off"},
       {"--apply-undo", "--undo", "--below", "--longest", "--loops", "--log", "--drop-components",
        "--fill-boundaries"}}};
  for (const auto& [words, options] : commands)
    for (const std::string& option : options)
      for (const std::vector<std::string>& given : {std::vector<std::string>{option, ""}, {option + "="}}) {
        std::vector<std::string> all = words;
        all.insert(all.begin() + 1, given.begin(), given.end());
        const Outcome outcome = reeb(all);
        EXPECT_EQ(outcome.exit_code, 2) << last_command() << outcome.error;
        EXPECT_NE(outcome.error.find("error: " + option + ": the value is empty"), std::string::npos) << outcome.error;
        EXPECT_EQ(files(), before) << last_command();
      }
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

TEST_F(CommandLine, UnexpectedWordsAreNamedInOrder) {
  write("-dash.off", kSmallOff);
  expect_success(reeb({"compute", "-o", "dash.reeb", "--", "-dash.off"}));
  expect_error(reeb({"--", "-dash.off", "-o"}), 2, "unexpected argument: -o");
  expect_error(reeb({"--", "-dash.off", "-o", "q.reeb"}), 2, "unexpected arguments: -o q.reeb");
  expect_error(reeb({"verify", "mesh.reeb", "one", "two"}), 2, "unexpected arguments: one two");
}

TEST_F(CommandLine, AWordTooManyNamesTheOptionThatMayBeMissing) {
  expect_success(reeb({"mesh.off"}));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"verify", "mesh.reeb", "mesh.off"}, {"extract", "mesh.reeb", "mesh.off"}})
    expect_error(reeb(words), 2, "unexpected argument: mesh.off (did you mean --mesh mesh.off?)");
  expect_error(reeb({"extract", "mesh.reeb", "out.json"}), 2,
               "unexpected argument: out.json (did you mean -o out.json?)");
  expect_error(reeb({"extract", "mesh.reeb", "--threshold", "5", "%"}), 2,
               "unexpected argument: % (write a percentage without a blank, as 5%)");
}

TEST_F(CommandLine, OptionsOfImagesNeedAMesh) {
  expect_success(reeb({"mesh.off"}));
  for (const std::vector<std::string>& option : std::vector<std::vector<std::string>>{
           {"--grid", "2x2"}, {"--type", "u8"}, {"--spacing", "1,1"}, {"--skip", "4"}, {"--nodata", "skip"}})
    for (const char* command : {"extract", "verify"}) {
      std::vector<std::string> words = {command, "mesh.reeb"};
      words.insert(words.end(), option.begin(), option.end());
      expect_error(reeb(words), 2, "--grid, --type, --spacing, --skip and --nodata say how a mesh is read");
    }
}

TEST_F(CommandLine, OptionsOfTheProgramAreGivenWithoutACommand) {
  const Outcome outcome = reeb({"extract", "--version"});
  expect_error(outcome, 2, "--version is an option of the program, not of a command");
  EXPECT_NE(outcome.error.find("hint: `reeb --version`"), std::string::npos) << outcome.error;
}

TEST_F(CommandLine, ASidecarThatIsNotKeptIsSaid) {
  write("mesh.sma", "v 0 0 0\nv 1 0 0\nv 0 1 1\nf -1 -2 -3\n");
  const auto notes_of = [this](const std::string& mesh) {
    Command command;
    command.input = in_folder("mesh.off");
    const Outcome outcome = reeb({mesh, "--sidecar", "-o", "s.reeb", "--force"}, command);
    expect_success(outcome);
    return lines_after("note: no sidecar was kept: ", outcome.error).size();
  };
  EXPECT_EQ(notes_of("-"), 1u);
  EXPECT_EQ(notes_of("mesh.sma"), 1u);
  EXPECT_EQ(notes_of("mesh.off"), 0u);
  EXPECT_EQ(notes_of("mesh.off"), 0u) << "it is there";
  EXPECT_TRUE(std::filesystem::exists(in_folder("mesh.off.final")));
}

TEST_F(CommandLine, AWordThatIsNoCommandNamesAMesh) {
  expect_success(reeb({"mesh.off"}));
  EXPECT_TRUE(std::filesystem::exists(in_folder("mesh.reeb")));
  expect_error(reeb({"missing.off"}), 1, "missing.off: ");
  expect_error(reeb({"./missing"}), 1, "./missing: ");
  std::filesystem::rename(in_folder("mesh.off"), in_folder("mesh"));
  expect_success(reeb({"mesh", "--force"}));
}

TEST_F(CommandLine, AWordThatIsNeitherCommandNorFileIsSaidToBe) {
  expect_error(reeb({"comptue"}), 2, "there is no command 'comptue', and no file of that name (did you mean compute?)");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"holes", "mesh.off"}, {"holes", "--help"}, {"help", "holes"}}) {
    const Outcome outcome = reeb(words);
    expect_error(outcome, 2, "there is no command 'holes'");
    EXPECT_NE(outcome.error.find("compute, info, extract"), std::string::npos) << outcome.error;
  }
}

TEST_F(CommandLine, HelpIsACommandToo) {
  EXPECT_EQ(reeb({"help"}).output, reeb({}).output);
  EXPECT_EQ(reeb({"help", "pairs"}).output, reeb({"pairs", "--help"}).output);
  EXPECT_EQ(reeb({"help", "pairs"}).exit_code, 0);
  EXPECT_NE(reeb({"help"}).output.find("\n       reeb MESH [OPTIONS]"), std::string::npos);
  expect_error(reeb({"help", "nothing"}), 2, "there is no command 'nothing'");
  EXPECT_EQ(reeb({"help", "nothing"}).error.find("no file"), std::string::npos);
}

TEST_F(CommandLine, HelpsFitEightyColumnsAndAreOfOneStyle) {
  std::vector<std::string> helps = {reeb({}).output};
  for (const std::string& name : subcommands()) helps.push_back(reeb({name, "--help"}).output);
  for (const std::string& help : helps) {
    for (const std::string& line : lines_after("", help)) EXPECT_LE(line.size(), 80u) << line;
    EXPECT_EQ(help.find("\n\n\n"), std::string::npos) << help;
    for (const char* of_the_library : {"REQUIRED", "UINT", "TEXT", "{false}", "Excludes", "Needs:", ":{", "INT in"})
      EXPECT_EQ(help.find(of_the_library), std::string::npos) << help;
    // Descriptions begin with a capital letter.
    for (const std::string& line : lines_after("  --", help)) {
      const auto at = line.find("  ");
      if (at == std::string::npos) continue;
      EXPECT_EQ(std::islower(static_cast<unsigned char>(line[line.find_first_not_of(' ', at)])), 0) << line;
    }
  }
}

TEST_F(CommandLine, UnknownOptionsAreNamedWithTheNearest) {
  expect_success(reeb({"mesh.off"}));
  expect_error(reeb({"mesh.off", "--foo"}), 2, "unknown option --foo (did you mean --force?)");
  expect_error(reeb({"mesh.off", "--memry=64M"}), 2, "unknown option --memry (did you mean --memory?)");
  expect_error(reeb({"--versions"}), 2, "unknown option --versions (did you mean --version?)");
  expect_error(reeb({"-v"}), 2, "unknown option -v");
  expect_error(reeb({"mesh.off", "b"}), 2, "unexpected argument: b");
  EXPECT_NE(reeb({"-v"}).error.find("hint: see `reeb --help` and `reeb compute --help`"), std::string::npos);
  expect_error(reeb({"-dash.off"}), 2, "unknown option -dash.off");
  expect_error(reeb({"extract", "mesh.reeb", "--node", "3"}), 2, "unknown option --node (did you mean --nodes?)");
  const Outcome outcome = reeb({"extract", "mesh.reeb", "--frist"});
  EXPECT_NE(outcome.error.find("hint: see `reeb extract --help`"), std::string::npos) << outcome.error;
  expect_error(reeb({"extract"}), 2, "FILE is missing");
  expect_error(reeb({"generate", "torus"}), 2, "--output is missing");
  const Outcome tree = reeb({"generate", "tree", "-o", "t.ply"});
  expect_error(tree, 2, "unknown kind of mesh 'tree'");
  EXPECT_TRUE(lines_after("hint: ", tree.error).at(0).ends_with(", ball, volume")) << tree.error;
  expect_error(reeb({"mesh.off", "-o"}), 2, "--output needs one value");
  expect_error(reeb({"mesh.off", "--report", "-o", "zz.reeb"}), 2, "--report needs one value");
  expect_error(reeb({"mesh.off", "--report", "--force"}), 2, "--report needs one value");
  expect_error(reeb({"extract", "mesh.reeb", "--nodes", "3", "--threshold", "1"}), 2);
  expect_error(reeb({"plot", "mesh.reeb", "--kind", "foo"}), 2,
               "--kind takes loops, diagram, graph or skeleton, not 'foo'");
  expect_error(reeb({"plot", "mesh.reeb", "--color", "red"}), 2, "--color takes value or arcs, not 'red'");
}

TEST_F(CommandLine, NegativeHugeAndEmptyNumbersAreRefused) {
  expect_success(reeb({"mesh.off"}));
  const std::vector<std::string> before = files();
  expect_error(reeb({"extract", "mesh.reeb", "--nodes", "-1"}), 2, "--nodes: \"-1\" is not a whole number");
  expect_error(reeb({"extract", "mesh.reeb", "--memory", ""}), 2, "--memory: the value is empty");
  expect_error(reeb({"generate", "torus", "--triangles", "-5", "-o", "t.ply"}), 2, "--triangles: \"-5\"");
  expect_error(reeb({"generate", "torus", "--triangles", "99999999999999999999", "-o", "t.ply"}), 2, "--triangles: ");
  expect_error(reeb({"generate", "torus", "--seed", "x", "-o", "t.ply"}), 2, "--seed: \"x\" is not a whole number");
  for (const char* option : {"--memory", "--chunk", "--threads", "--snapshot-every", "--buckets"})
    for (const char* value : {"", "-1", "1e300", "lots"})
      expect_error(reeb({"mesh.off", "--force", option, value}), 2, std::string(option) + ": ");
  expect_error(reeb({"mesh.off", "--force", "--chunk", "0"}), 2, "--chunk must be at least 1");
  EXPECT_EQ(files(), before);
}

TEST_F(CommandLine, CountsTakeUnitsEverywhere) {
  expect_success(reeb({"generate", "torus", "--triangles", "1.5k", "-o", "t.sma"}));
  expect_success(reeb({"t.sma", "--chunk", "1k", "--snapshot-every", "1e3", "--buckets", "0.1k", "--memory", "32m"}));
  EXPECT_EQ(files(), (std::vector<std::string>{"mesh.off", "t-000001.reeb", "t.reeb", "t.sma"}));
  expect_success(reeb({"extract", "t.reeb", "--nodes", "1k"}));
}

TEST_F(CommandLine, OptionsThatAKindOfMeshDoesNotHaveAreRefused) {
  expect_error(reeb({"generate", "torus", "--dimension", "4", "-o", "t.ply"}), 2, "a torus has no --dimension");
  expect_error(reeb({"generate", "sierpinski", "--width", "9", "-o", "t.ply"}), 2, "a sierpinski has no --width");
  for (const std::string option : {"--triangles", "--tetrahedra", "--width", "--dimension"})
    expect_error(reeb({"generate", "volume", "--grid", "5x5x5", option, "5", "-o", "v.nrrd"}), 2,
                 "a volume has no " + option);
  expect_error(reeb({"generate", "volume", "--grid", "5x5x5", "--order", "rows", "-o", "v.nrrd"}), 2,
               "a volume has no --order");
  const Outcome seeded = reeb({"generate", "torus", "--triangles", "1k", "--seed", "7", "-o", "t.ply"});
  expect_success(seeded);
  EXPECT_EQ(lines_after("note: ", seeded.error).size(), 1u) << seeded.error;
  const Outcome far = reeb({"generate", "sierpinski", "--triangles", "2k", "-o", "s.ply"});
  expect_success(far);
  EXPECT_NE(far.error.find("note: asked for 2,000 triangles;"), std::string::npos) << far.error;
  const Outcome whole = reeb({"generate", "sierpinski", "--triangles", "1k", "-o", "s.cx"});
  expect_success(whole);
  EXPECT_NE(whole.error.find("wrote s.cx: 514 vertices, 256 tetrahedra"), std::string::npos) << whole.error;
  const Outcome near = reeb({"generate", "torus", "--triangles", "2k", "-o", "u.ply"});
  EXPECT_EQ(lines_after("note: ", near.error).size(), 0u) << near.error;
}

TEST_F(CommandLine, TheSuffixOfAGraphMayBeInCapitals) {
  expect_success(reeb({"mesh.off"}));
  expect_success(reeb({"extract", "mesh.reeb", "-o", "graph.JSON"}));
  expect_success(reeb({"extract", "mesh.reeb", "--format", "json", "-o", "graph"}));
  EXPECT_EQ(file("graph.JSON"), file("graph"));
  expect_error(reeb({"extract", "mesh.reeb", "-o", "out"}), 2, "out: cannot tell the format of the graph");
  expect_error(reeb({"extract", "mesh.reeb", "-o", "out.pdf"}), 2, "out.pdf: cannot tell the format of the graph");
}

TEST_F(CommandLine, OutputsAreNamedWhenTheyAreWritten) {
  expect_success(reeb({"mesh.off"}));
  EXPECT_EQ(reeb({"extract", "mesh.reeb", "-o", "g.csv"}).error, "wrote g.nodes.csv and g.arcs.csv\n");
  EXPECT_EQ(reeb({"extract", "mesh.reeb", "-o", "g.json"}).error, "wrote g.json\n");
  EXPECT_EQ(reeb({"pairs", "mesh.reeb", "-o", "p.json"}).error, "wrote p.json\n");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"extract", "mesh.reeb", "-o", "q.json", "--quiet"},
                                             {"pairs", "mesh.reeb", "-o", "q.csv", "--quiet"},
                                             {"extract", "mesh.reeb", "-o", "-"},
                                             {"pairs", "mesh.reeb"}})
    EXPECT_EQ(reeb(words).error, "") << last_command();
  const Outcome other = reeb({"mesh.off", "-o", "mesh.json"});
  EXPECT_EQ(lines_after("note: mesh.json is a .reeb file", other.error).size(), 1u) << other.error;
}

TEST_F(CommandLine, OptionsOfOtherCommandsHaveAHint) {
  const auto hint_of = [this](const std::vector<std::string>& words) {
    const Outcome outcome = reeb(words);
    expect_error(outcome, 2);
    const auto hints = lines_after("hint: ", outcome.error);
    return hints.empty() ? std::string() : hints[0];
  };
  expect_success(reeb({"mesh.off"}));
  const std::string levels = "levels are chosen afterwards: `reeb extract FILE.reeb --threshold 1%`";
  EXPECT_EQ(hint_of({"mesh.off", "--threshold", "1%", "--force"}), levels);
  EXPECT_EQ(hint_of({"pairs", "mesh.reeb", "--threshold=1%"}), levels);
  EXPECT_EQ(hint_of({"convert", "mesh.off", "-o", "z.obj"}), "the output is the second argument: reeb convert IN OUT");
}

TEST_F(CommandLine, ALargeThresholdMayBeMeantInPerCent) {
  EXPECT_EQ(lines_after("note: the threshold 4 is more than the range 1 of z; did you mean 4%?",
                        reeb({"mesh.off", "--denoise", "4"}).error)
                .size(),
            1u);
  EXPECT_EQ(reeb({"extract", "mesh.reeb", "--threshold", "4"}).error,
            "note: the threshold 4 is more than the range 1 of z; did you mean 4%?\n");
  EXPECT_EQ(reeb({"extract", "mesh.reeb", "--threshold", "4%"}).error, "");
}

TEST_F(CommandLine, ThresholdsOfLevelsCanBeTyped) {
  expect_success(reeb({"generate", "scan", "--triangles", "40k", "-o", "scan.ply"}));
  expect_success(reeb({"compute", "scan.ply", "-f", "x", "-o", "scan.reeb"}));
  const auto levels = nlohmann::json::parse(reeb({"info", "scan.reeb", "--json"}).output).at("levels");
  const std::string text = reeb({"info", "scan.reeb"}).output;
  std::istringstream lines(text.substr(text.find('\n', text.find("of range"))));
  ASSERT_GT(levels.size(), 3u);
  for (const auto& level : levels) {
    std::string threshold, rest;
    lines >> threshold;
    std::getline(lines, rest);
    EXPECT_LE(threshold.size(), 12u) << "no more digits than it takes";
    expect_success(reeb({"extract", "scan.reeb", "--threshold", threshold, "-o", "level.json", "--force"}));
    EXPECT_EQ(nlohmann::json::parse(file("level.json")).at("threshold"), level.at("threshold")) << threshold;
  }
}

TEST_F(CommandLine, PairsHaveTheFormatOfTheirSuffix) {
  expect_success(reeb({"mesh.off"}));
  const std::string csv = reeb({"pairs", "mesh.reeb"}).output;
  for (const char* name : {"p.csv", "p.CSV", "p"}) {
    expect_success(reeb({"pairs", "mesh.reeb", "-o", name}));
    EXPECT_EQ(file(name), csv) << name;
  }
  expect_success(reeb({"pairs", "mesh.reeb", "-o", "p.json"}));
  EXPECT_EQ(file("p.json"), reeb({"pairs", "mesh.reeb", "--format", "json"}).output);
  expect_error(reeb({"pairs", "mesh.reeb", "-o", "p.gudhi"}), 2, "p.gudhi: cannot tell the format of the pairs");
  expect_success(reeb({"pairs", "mesh.reeb", "-o", "p.gudhi", "--format", "gudhi"}));
  EXPECT_EQ(file("p.gudhi"), reeb({"pairs", "mesh.reeb", "--format", "gudhi"}).output);
}

// Many pairs have the same persistence: values are 0 to 4.
TEST_F(CommandLine, PairsAreSortedByPersistenceTypeAndVertices) {
  constexpr int kVertices = 120;
  std::string mesh;
  for (int v = 0; v < kVertices; ++v) mesh += "v " + std::to_string(v * v % 7 % 5) + "\n";
  for (int v = 0; v < kVertices; ++v)
    for (const int step : {1, 12})
      if (v + step < kVertices) mesh += "s " + std::to_string(v) + " " + std::to_string(v + step) + "\n";
  write("ties.cx", mesh + "v 0\nv 1\nv 4\n");  // more components
  expect_success(reeb({"compute", "ties.cx", "-f", "x", "-o", "ties.reeb", "--quiet"}));
  // The names of the types are in the order of the alphabet.
  std::vector<std::tuple<double, std::string, int, int>> rows;
  for (const std::string& line : lines_after("", reeb({"pairs", "ties.reeb"}).output)) {
    std::vector<std::string> words;
    std::istringstream text(line);
    for (std::string word; std::getline(text, word, ',');) words.push_back(word);
    ASSERT_EQ(words.size(), 13u) << line;
    if (words[0] != "type") rows.emplace_back(-std::stod(words[5]), words[0], std::stoi(words[1]), std::stoi(words[2]));
  }
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  std::size_t same_persistence = 0, same_type = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (std::get<0>(rows[i]) != std::get<0>(rows[i - 1])) continue;
    ++(std::get<1>(rows[i]) == std::get<1>(rows[i - 1]) ? same_type : same_persistence);
  }
  EXPECT_GT(same_persistence, 3u);
  EXPECT_GT(same_type, 10u);
}

TEST_F(CommandLine, TheSummaryListsLoopsAndExtremaAndFitsEightyColumns) {
  expect_success(reeb({"generate", "scan", "--triangles", "20k", "-o", "scan.ply"}));
  const Outcome outcome = reeb({"scan.ply"});
  expect_success(outcome);
  for (const std::string& line : lines_after("", outcome.error)) EXPECT_LE(line.size(), 80u) << line;
  const auto pairs = reeb({"pairs", "scan.reeb"}).output;
  const std::size_t loops = lines_after("Ext1,", pairs).size();
  const std::size_t others = lines_after("Ord0,", pairs).size() + lines_after("Rel1,", pairs).size();
  EXPECT_EQ(lines_after("  largest loops (" + std::to_string(loops) + " in all):", outcome.error).size(), 1u);
  EXPECT_EQ(lines_after("    loop ", outcome.error).size(), 5u) << outcome.error;
  EXPECT_EQ(lines_after("  largest minima and maxima (" + std::to_string(others) + " in all):", outcome.error).size(),
            1u)
      << outcome.error;
  EXPECT_EQ(lines_after("    m", outcome.error).size(), 5u) << outcome.error;
  EXPECT_EQ(lines_after("  mesh: ", outcome.error).size(), 1u);
  EXPECT_EQ(lines_after("  wrote to standard output", reeb({"scan.ply", "-o", "-"}).error).size(), 1u);
}

TEST_F(CommandLine, TheSummarySaysHowManyFeaturesAreAboveZero) {
  // A path that goes up to 2, down to 1, up to 3, and on a plateau down and up only by index.
  write("path.cx", "v 0\nv 2\nv 1\nv 3\nv 4\nv 3\nv 3\ns 0 1\ns 1 2\ns 2 3\ns 3 6\ns 6 5\ns 5 4\n");
  const Outcome outcome = reeb({"path.cx"});
  expect_success(outcome);
  std::size_t all = 0, above = 0;
  for (const char* type : {"Ord0,", "Rel1,"})
    for (const std::string& row : lines_after(type, reeb({"pairs", "path.reeb"}).output)) {
      ++all;
      above += row.find(",3,3,0,") == std::string::npos;
    }
  EXPECT_LT(above, all);
  EXPECT_EQ(lines_after("  largest minima and maxima (" + std::to_string(above) + " above zero, " +
                            std::to_string(all) + " in all):",
                        outcome.error)
                .size(),
            1u)
      << outcome.error;
  EXPECT_EQ(lines_after("    m", outcome.error).size(), above);
}

TEST_F(CommandLine, TheSummaryNamesLikelyDefects) {
  const auto generated = reeb({"generate", "scan", "--triangles", "40k", "-o", "scan.ply"});
  EXPECT_NE(generated.error.find("genus 36"), std::string::npos) << generated.error;
  const Outcome scan = reeb({"compute", "scan.ply", "-f", "x", "-o", "scan.reeb"});
  const auto lines = lines_after("  likely defects by persistence: 36 loops of at most ", scan.error);
  ASSERT_EQ(lines.size(), 1u) << scan.error;
  EXPECT_NE(scan.error.find("`reeb defects scan.ply scan.reeb`"), std::string::npos);
  expect_success(reeb({"generate", "torus", "--triangles", "1k", "-o", "torus.ply"}));
  EXPECT_EQ(reeb({"torus.ply"}).error.find("likely"), std::string::npos) << "its one loop is as long as it is";
}

TEST_F(CommandLine, TheSummarySaysThatTrianglesShareNoVertices) {
  const std::string text = "  most triangles share no vertex with others";
  std::string apart = "OFF\n300 100 0\n", joined = "OFF\n102 100 0\n", points = "OFF\n302 100 0\n";
  const auto vertex = [](int i) {
    return std::to_string(i % 2) + " " + std::to_string(i) + " " + std::to_string(i) + "\n";
  };
  for (int i = 0; i < 300; ++i) apart += vertex(i);
  for (int i = 0; i < 102; ++i) joined += vertex(i);
  for (int i = 0; i < 302; ++i) points += vertex(i);
  for (int i = 0; i < 100; ++i) {
    const auto corners = [](int a) {
      return "3 " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(a + 2) + "\n";
    };
    apart += corners(3 * i);
    joined += corners(i);
    points += corners(i);
  }
  write("apart.off", apart);
  write("joined.off", joined);
  write("points.off", points);  // 200 vertices of no triangle
  EXPECT_EQ(lines_after(text, reeb({"apart.off"}).error).size(), 1u);
  for (const char* mesh : {"joined.off", "points.off"}) {
    const Outcome outcome = reeb({mesh});
    expect_success(outcome);
    EXPECT_EQ(lines_after(text, outcome.error).size(), 0u) << outcome.error;
  }
  // Who asks for tunnels would be told that there are none.
  const std::string note = "note: most triangles share no vertex with others";
  EXPECT_EQ(lines_after(note, reeb({"defects", "apart.off"}).error).size(), 1u);
  EXPECT_EQ(lines_after(note, reeb({"repair", "apart.off", "-o", "r.off"}).error).size(), 1u);
  EXPECT_EQ(lines_after(note, reeb({"defects", "joined.off"}).error).size(), 0u);
}

TEST_F(CommandLine, ThePeakIsNotThatOfWhoeverStartedTheProgram) {
  constexpr std::size_t kBytes = std::size_t{256} << 20;
  const std::string large(kBytes, 'x');  // of this process
  expect_success(reeb({"generate", "torus", "--triangles", "1k", "-o", "torus.ply"}));
  expect_success(reeb({"torus.ply", "--report", "torus.json"}));
  EXPECT_LT(nlohmann::json::parse(file("torus.json"))["peak_rss_bytes"].get<std::size_t>(), kBytes) << large.size();
}

// All values are equal, so all pairs have persistence zero.
TEST_F(CommandLine, FeaturesWithoutPersistenceAreNotListed) {
  expect_success(reeb({"generate", "grid", "--triangles", "1k", "-o", "grid.ply"}));
  const Outcome outcome = reeb({"grid.ply"});
  expect_success(outcome);
  EXPECT_EQ(outcome.error.find("largest"), std::string::npos) << outcome.error;
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
  // The command line comes first.
  expect_error(reeb({"compute", "mesh.off", "--denoise", "1mm"}), 2, "--denoise: ");
  const Outcome many = reeb({"compute", "mesh.off"}, {.arguments = {}, .wrapper = {"env", "OMPI_COMM_WORLD_SIZE=2"}});
  expect_error(many, 1, "mesh.reeb:");
  EXPECT_NE(many.error.find("hint: under mpirun, use reeb-mpi"), std::string::npos) << many.error;
  // As after an interruption between the outputs of two functions.
  const Outcome resumed = reeb({"compute", "mesh.off", "--resume"});
  expect_error(resumed, 1, "mesh.reeb:");
  EXPECT_NE(resumed.error.find("there is nothing to resume"), std::string::npos) << resumed.error;
  EXPECT_NE(resumed.error.find("--force"), std::string::npos) << resumed.error;
  EXPECT_EQ(file("mesh.reeb"), "precious");
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
    const Outcome report = reeb({"compute", "mesh.off", "-o", "new.reeb", "--report", folder + "/r.json"});
    expect_error(report, 3);
    EXPECT_NE(report.error.find("--report FILE"), std::string::npos) << report.error;
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
  expect_unsigned(report.at("live_max"), {"vertices", "edges", "arcs", "bytes"});
  EXPECT_TRUE(report.at("reordered").is_boolean());
  EXPECT_TRUE(report.at("output").is_string());
}

// The range is 2e308, and the loop has 35 % of it.
TEST_F(CommandLine, ARangeBeyondTheDoublesHasShares) {
  write("loop.obj",
        "v 0 0 -1e308\nv 0 0 -2e307\nv 1 0 0\nv -1 0 0\nv 0 0 5e307\nv 0 0 1e308\n"
        "l 1 2\nl 2 3\nl 2 4\nl 3 5\nl 4 5\nl 5 6\n");
  const Outcome outcome = reeb({"compute", "loop.obj"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find("35.00 %"), std::string::npos) << outcome.error;
  EXPECT_NE(reeb({"info", "loop.reeb"}).output.find("35 %"), std::string::npos);
  EXPECT_EQ(lines_after("n ", reeb({"extract", "loop.reeb", "--threshold", "34%"}).output).size(), 4u);
  EXPECT_EQ(lines_after("n ", reeb({"extract", "loop.reeb", "--threshold", "36%"}).output).size(), 2u);
  for (const char* format : {"json", "gltf"}) {
    const Outcome graph = reeb({"extract", "loop.reeb", "--format", format});
    EXPECT_TRUE(nlohmann::json::accept(graph.output)) << graph.output;
  }
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
