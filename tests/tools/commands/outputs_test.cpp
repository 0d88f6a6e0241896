// What the program writes destroys no file (docs/RELIABILITY.md, Outputs). Runs the program as a user does.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Outputs : public ProgramTest {
 protected:
  void SetUp() override { write("mesh.off", kSmallOff); }

  // Runs it without and with --force. Expects exit code 1, this begin of the error, and that no file has changed.
  void expect_refused(const Words& words, const std::string& error_begin, const std::string& input = "/dev/null") {
    const auto before = contents();
    for (const bool force : {false, true}) {
      Words all = words;
      if (force) all.emplace_back("--force");
      expect_error(reeb(all, {.arguments = {}, .input = input}), 1, error_begin);
      EXPECT_EQ(contents(), before) << last_command();
    }
  }

  std::vector<std::pair<std::string, std::string>> contents() const {
    std::vector<std::pair<std::string, std::string>> all;
    for (const std::string& name : files())
      all.emplace_back(name, fs::is_regular_file(in_folder(name)) ? file(name) : "");
    return all;
  }

  void make_graph() { expect_success(reeb({"compute", "mesh.off", "-o", "g.reeb", "--quiet"})); }

  // Runs a line of bash in which "$@" is the program with `words`.
  Outcome in_shell(const std::string& line, const Words& words) {
    return reeb(words, {.arguments = {}, .wrapper = {"bash", "-c", line, "bash"}});
  }
};

TEST_F(Outputs, AMeshIsNeverAnOutput) {
  fs::create_symlink("mesh.off", in_folder("link"));
  fs::create_hard_link(in_folder("mesh.off"), in_folder("hard"));
  fs::create_directory(in_folder("sub"));
  for (const std::string name : {"mesh.off", "link", "hard", "./mesh.off", "sub/../mesh.off"}) {
    expect_refused({"compute", "mesh.off", "-o", name}, name + ": the output is the mesh itself");
    expect_refused({"compute", "mesh.off", "-o", "new.reeb", "--report", name},
                   name + ": the report is the mesh itself");
  }
  expect_refused({"compute", "link", "-o", "hard"}, "hard: the output is the mesh itself");
  expect_refused({"compute", "-", "-o", "mesh.off"}, "mesh.off: the output is the mesh itself", in_folder("mesh.off"));
  fs::create_symlink("../mesh.off", in_folder("sub/link.off"));
  for (const std::string name : {"mesh.off", "sub/link.off"})
    expect_refused({"convert", "mesh.off", name}, name + ": the output is the mesh itself");
}

// Its default output has its own name.
TEST_F(Outputs, AGraphIsNoMesh) {
  make_graph();
  expect_refused({"g.reeb"}, "g.reeb: this is a Reeb graph already, not a mesh");
}

TEST_F(Outputs, AFileOfValuesIsNeverAnOutput) {
  write("values.txt", "1\n2\n3\n4\n");
  expect_refused({"compute", "mesh.off", "-f", "file:values.txt", "-o", "values.txt"},
                 "values.txt: the output is the file of values itself");
  write("values.ply", "1\n2\n3\n4\n");
  expect_refused({"convert", "mesh.off", "values.ply", "--order", "sweep:file:values.ply"},
                 "values.ply: the output is the file of values itself");
}

// Of the functions of graphs and of tables of loops, which are not on the command line.
TEST_F(Outputs, AFileOfValuesOfAGraphIsNeverAnOutput) {
  write("values.txt", "1\n2\n3\n4\n");
  fs::create_symlink("values.txt", in_folder("link.svg"));
  write("o.csv", "lo,hi,function\n0,3,file:values.txt\n");
  expect_success(reeb({"compute", "mesh.off", "-f", "file:values.txt", "-o", "g.reeb", "--quiet"}));
  const std::string output = "values.txt: the output is the file of values itself";
  expect_refused({"defects", "mesh.off", "g.reeb", "-o", "values.txt"}, output);
  if (REEB_WEB) expect_refused({"report", "g.reeb", "--mesh", "mesh.off", "-o", "values.txt"}, output);
  expect_refused({"plot", "g.reeb", "--kind", "skeleton", "--surface", "value", "--mesh", "mesh.off", "-o", "link.svg"},
                 "link.svg: the picture is the file of values itself");
  expect_refused({"repair", "mesh.off", "--loops", "o.csv", "-o", "r.ply", "--log", "values.txt"},
                 "values.txt: the log is the file of values itself");
}

// The vertices of TetGen, and the data of an image whose header is in a file of its own.
TEST_F(Outputs, AnotherFileOfAMeshIsNeverAnOutput) {
  write("t.ele", "1 4 0\n1 1 2 3 4\n");
  write("t.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
  write("v.nhdr", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 3 3\nencoding: raw\ndata file: d.ply\n\n");
  write("v.mhd", "NDims = 2\nDimSize = 3 3\nElementType = MET_UCHAR\nElementDataFile = d.ply\n");
  write("d.ply", "123456789");
  std::string nifti(348, '\0');
  for (const auto& [at, byte] :
       {std::pair(0, 348 & 255), std::pair(1, 348 >> 8), std::pair(40, 2), std::pair(42, 3), std::pair(44, 3),
        std::pair(70, 2), std::pair(344, int{'n'}), std::pair(345, int{'i'}), std::pair(346, int{'1'})})
    nifti[static_cast<std::size_t>(at)] = static_cast<char>(byte);
  write("n.hdr", nifti);
  write("n.img", "123456789");
  for (const auto& [mesh, other] : {std::pair("t.ele", "t.node"), std::pair("v.nhdr", "d.ply"),
                                    std::pair("v.mhd", "d.ply"), std::pair("n.hdr", "n.img")}) {
    const std::string name = other;
    expect_refused({"compute", mesh, "-o", other}, name + ": the output is a file of the mesh itself");
    expect_refused({"compute", mesh, "-o", "new.reeb", "--report", other}, name + ": the report is a file of the mesh");
    expect_success(reeb({"compute", mesh, "-o", "g.reeb", "--quiet", "--force"}));
  }
  expect_success(reeb({"compute", "v.nhdr", "-o", "g.reeb", "--quiet", "--force"}));
  fs::create_symlink("d.ply", in_folder("link.svg"));
  const std::string output = "d.ply: the output is a file of the mesh itself";
  expect_refused({"fragment", "v.nhdr", "--part", "1/2", "-o", "d.ply"}, output);
  expect_refused({"function", "v.nhdr", "-o", "d.ply"}, output);
  expect_refused({"convert", "v.nhdr", "d.ply"}, output);
  expect_refused({"segment", "v.nhdr", "g.reeb", "-o", "d.ply"}, output);
  expect_refused({"extract", "g.reeb", "--mesh", "v.nhdr", "--format", "json", "-o", "d.ply"}, output);
  expect_refused({"defects", "v.nhdr", "g.reeb", "-o", "d.ply"}, output);
  expect_refused({"repair", "v.nhdr", "-o", "d.ply"}, output);
  if (REEB_WEB) expect_refused({"report", "g.reeb", "--mesh", "v.nhdr", "-o", "d.ply"}, output);
  expect_refused({"plot", "g.reeb", "--kind", "skeleton", "--mesh", "v.nhdr", "-o", "link.svg"},
                 "link.svg: the picture is a file of the mesh itself");
  expect_error(in_shell("\"$@\" >>d.ply", {"info", "v.nhdr"}), 1, "-: the output is a file of the mesh itself");
  EXPECT_EQ(file("d.ply"), "123456789");
  // The header of a pipe cannot be looked at before.
  ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
  expect_error(in_shell("cat v.nhdr >pipe & \"$@\"", {"compute", "pipe", "-o", "d.ply", "--force"}), 1,
               "pipe: the data are in another file, which a pipe does not have");
  // As raw values, the header is read alone.
  const std::string bytes = std::to_string(file("v.nhdr").size()) + "x1";
  expect_success(reeb({"compute", "v.nhdr", "--grid", bytes, "--type", "u8", "-o", "d.ply", "--force", "--quiet"}));
}

TEST_F(Outputs, AGraphThatIsReadIsNeverAnOutput) {
  make_graph();
  expect_refused({"extract", "g.reeb", "-o", "g.reeb", "--format", "json"}, "g.reeb: the output is the .reeb file");
  expect_refused({"pairs", "g.reeb", "-o", "./g.reeb"}, "./g.reeb: the output is the .reeb file itself");
}

// The shell appends to it what is printed.
TEST_F(Outputs, WhatIsReadIsNeverStandardOutput) {
  make_graph();
  const auto before = contents();
  const auto expect_refusal = [&](const Words& words, const std::string& name, const std::string& error) {
    expect_error(in_shell("timeout 20 \"$@\" >>" + name, words), 1, error);
    EXPECT_EQ(contents(), before) << last_command();
  };
  const std::string graph = "-: the output is the .reeb file itself", mesh = "-: the output is the mesh itself";
  for (const Words& words : {Words{"pairs", "g.reeb"}, Words{"extract", "g.reeb"}, Words{"info", "g.reeb"},
                             Words{"verify", "g.reeb"}, Words{"verify", "g.reeb", "--mesh", "mesh.off"}})
    expect_refusal(words, "g.reeb", graph);
  expect_refusal({"info", "mesh.off"}, "mesh.off", mesh);
  expect_refusal({"verify", "g.reeb", "--mesh", "mesh.off"}, "mesh.off", mesh);
  expect_refusal({"extract", "g.reeb", "--mesh", "mesh.off", "--format", "json"}, "mesh.off", mesh);
  expect_refusal({"defects", "mesh.off", "g.reeb"}, "mesh.off", "-: the table is the mesh itself");
  expect_refusal({"defects", "mesh.off", "g.reeb", "-o", "o.csv"}, "g.reeb", "-: the table is a .reeb file itself");
  if (REEB_WEB) expect_refusal({"view", "g.reeb"}, "g.reeb", "-: the address is the .reeb file itself");
}

TEST_F(Outputs, TablesAppearBothOrNot) {
  make_graph();
  expect_success(reeb({"extract", "g.reeb", "-o", "t.CSV"}));
  const std::string nodes = file("t.nodes.csv"), arcs = file("t.arcs.csv");
  EXPECT_EQ(nodes + "\n" + arcs, reeb({"extract", "g.reeb", "--format", "csv"}).output);
  fs::remove(in_folder("t.nodes.csv"));
  expect_error(reeb({"extract", "g.reeb", "-o", "t.csv"}), 1, "t.arcs.csv: ");
  EXPECT_FALSE(fs::exists(in_folder("t.nodes.csv")));
  expect_success(reeb({"extract", "g.reeb", "-o", "t", "--format", "csv", "--force"}));
  EXPECT_EQ(file("t.nodes.csv"), nodes);
  expect_error(reeb({"extract", "g.reeb", "-o", "none/t.csv"}), 3);
}

TEST_F(Outputs, NoTwoOutputsAreOneFile) {
  expect_refused({"compute", "mesh.off", "-o", "x.out", "--report", "./x.out"},
                 "./x.out: the report and the output are the same file");
  expect_refused({"compute", "mesh.off", "-f", "x", "-f", "x", "-o", "m.reeb"}, "-f x is given twice");
  expect_refused({"fragment", "mesh.off", "-f", "x", "-f", "x", "--part", "1/2"}, "-f x is given twice");
  expect_refused({"compute", "mesh.off", "-o", "-", "--report", "-"}, "-: the report and the output");
  expect_refused({"compute", "mesh.off", "-o", "o.reeb", "--snapshot-every", "1", "--report", "o-000007.reeb"},
                 "o-000007.reeb: the report has the name of a snapshot");
  expect_refused({"compute", "mesh.off", "-o", "mesh.off.final", "--sidecar"},
                 "mesh.off.final: the sidecar and the output are the same file");
  expect_refused({"compute", "mesh.off", "-o", "o.reeb", "--report", "o.reeb.partial"},
                 "o.reeb.partial: the report is the folder of the run itself");
}

// Whatever its rank: of which rows there are patches is known after the work only.
TEST_F(Outputs, APatchIsNoInputAndNoOtherOutput) {
  make_graph();
  fs::create_directory(in_folder("near"));
  write("near/defect-3.ply", kSmallOff);
  expect_refused({"defects", "near/defect-3.ply", "--patches", "near"},
                 "near/defect-3.ply: a patch is the mesh itself");
  EXPECT_EQ(file("near/defect-3.ply"), kSmallOff);
  fs::create_symlink("../g.reeb", in_folder("near/defect-12-curves.ply"));
  expect_refused({"defects", "mesh.off", "g.reeb", "--patches", "./near/"},
                 "./near//defect-12-curves.ply: a patch is a .reeb file itself");
  expect_refused({"defects", "mesh.off", "-o", "defect-1.ply", "--patches", "."},
                 "defect-1.ply: the output has the name of a patch");
  fs::create_symlink("defect-20-curves.ply", in_folder("o.csv"));
  expect_refused({"defects", "mesh.off", "-o", "o.csv", "--patches", "."}, "o.csv: the output has the name of a patch");
  expect_refused({"defects", "mesh.off", "-o", "new", "--patches", "new"},
                 "new: the folder of patches and the output are the same file");
  for (const char* name : {"defect-1.csv", "defect-01.ply", "defect-a.ply", "defect-.ply"})
    expect_success(reeb({"defects", "mesh.off", "-o", name, "--patches", "."}));
}

TEST_F(Outputs, SeveralOutputsNeedAFile) {
  const std::string error = "several outputs cannot go to /dev/null";
  expect_error(reeb({"compute", "mesh.off", "-o", "/dev/null", "-f", "x", "-f", "y"}), 2, error);
  expect_error(reeb({"compute", "mesh.off", "-o", "/dev/null", "--snapshot-every", "1"}), 2, error);
  expect_error(reeb({"fragment", "mesh.off", "--part", "1/2", "-o", "/dev/null", "-f", "x", "-f", "y"}), 2, error);
  expect_success(reeb({"compute", "mesh.off", "-o", "/dev/null", "-f", "x"}));
  for (const char* name : {"/dev/null-x.reeb", "/dev/null-000001.reeb", "/dev/null-x.fragment"})
    EXPECT_FALSE(fs::exists(name)) << name;
}

TEST_F(Outputs, ASnapshotReplacesAFileOnlyByForce) {
  write("o-000002.reeb", "precious");
  const auto before = contents();
  expect_error(reeb({"compute", "mesh.off", "-o", "o.reeb", "--snapshot-every", "1"}), 1, "o-000002.reeb:");
  EXPECT_EQ(contents(), before);
  write("o-000009.reeb", "of an earlier run");
  const Outcome forced = reeb({"compute", "mesh.off", "-o", "o.reeb", "--snapshot-every", "2", "--force"});
  expect_success(forced);
  EXPECT_NE(file("o-000002.reeb"), "precious");
  EXPECT_EQ(lines_after("note: snapshots of an earlier run are left: o-000009.reeb", forced.error).size(), 1u)
      << forced.error;
  EXPECT_EQ(file("o-000009.reeb"), "of an earlier run");
  fs::create_hard_link(in_folder("mesh.off"), in_folder("p-000005.reeb"));
  expect_refused({"compute", "mesh.off", "-o", "p.reeb", "--snapshot-every", "1"},
                 "p-000005.reeb: a snapshot is the mesh itself");
}

// The name is taken while the run waits for its mesh.
TEST_F(Outputs, ASnapshotThatAppearsDuringTheRunIsKept) {
  write("kept", "precious");
  const std::string taking = "(cat mesh.off | (head -c 20; sleep 0.3; cp kept o-000001.reeb; cat)) | \"$@\"";
  const Outcome outcome = in_shell(taking, {"compute", "-", "-o", "o.reeb", "--snapshot-every", "2"});
  expect_error(outcome, 1, "o-000001.reeb: another program made this file");
  EXPECT_EQ(file("o-000001.reeb"), "precious");
  EXPECT_FALSE(fs::exists(in_folder("o.reeb")));
}

// Two runs from standard input to one output: the other one ends first.
TEST_F(Outputs, AResultWhoseNameWasTakenIsKeptUnderAnother) {
  write("kept", "precious");
  expect_success(reeb({"generate", "torus", "--triangles", "20000", "-o", "t.off"}));
  const std::string taking = "(head -c 600000; sleep 1; cp kept o.reeb; cat) <t.off | \"$@\"";
  expect_error(in_shell(taking, {"compute", "-", "-o", "o.reeb", "--quiet"}), 1, "o.reeb: another program made this");
  EXPECT_EQ(file("o.reeb"), "precious");
  expect_success(reeb({"verify", "o.reeb.2", "--mesh", "t.off"}));
}

TEST_F(Outputs, ASidecarReplacesOnlyASidecar) {
  expect_success(reeb({"generate", "torus", "--triangles", "1000", "-o", "t.ply"}));
  write("t.ply.final", "precious");
  expect_error(reeb({"compute", "t.ply", "--sidecar"}), 1, "t.ply.final: the output exists");
  EXPECT_EQ(file("t.ply.final"), "precious");
  EXPECT_FALSE(fs::exists(in_folder("t.reeb")));
  expect_success(reeb({"compute", "t.ply", "--sidecar", "--force"}));
  EXPECT_NE(file("t.ply.final"), "precious");
  expect_success(reeb({"compute", "t.ply", "--sidecar", "-o", "again.reeb"}));
  expect_refused({"compute", "t.ply", "-o", "t.ply.final"}, "t.ply.final: the output is the sidecar of the mesh");
}

TEST_F(Outputs, WhatCannotBeWrittenIsSaidBeforeAnyWork) {
  make_graph();
  fs::create_directory(in_folder("folder"));
  // The mesh is bad too, but is not read.
  write("bad.off", "OFF\n");
  const auto before = files();
  const std::string long_name = std::string(250, 'x');
  for (const std::string& name : {std::string("/nonexistent/a.reeb"), long_name}) {
    expect_error(reeb({"compute", "bad.off", "-o", name}), 3);
    expect_error(reeb({"compute", "bad.off", "-o", "new.reeb", "--report", name}), 3);
    expect_error(reeb({"extract", "g.reeb", "-o", name, "--format", "rg"}), 3);
    expect_error(reeb({"pairs", "g.reeb", "-o", name}), 3);
    expect_error(reeb({"convert", "bad.off", name + ".ply"}), 3);
    expect_error(reeb({"generate", "torus", "-o", name + ".ply"}), 3);
  }
  // 255 bytes are allowed, but a temporary file has 18 more.
  const Outcome too_long = reeb({"compute", "bad.off", "-o", std::string(238, 'x')});
  expect_error(too_long, 3);
  EXPECT_NE(too_long.error.find("choose a name of at most 237 bytes"), std::string::npos) << too_long.error;
  // A folder is an output that exists, and one that nothing can write.
  for (const auto& [option, code] : {std::pair("--quiet", 1), std::pair("--force", 3)}) {
    expect_error(reeb({"compute", "bad.off", "-o", "folder", option}), code, "folder: the output is a folder");
    expect_error(reeb({"compute", "bad.off", "-o", "new.reeb", "--report", "folder", option}), code, "folder: the out");
  }
  expect_error(reeb({"compute", "bad.off", "-o", "o.reeb", "--snapshot-every", "1", "--temp-dir", "/nonexistent"}), 1);
  EXPECT_EQ(files(), before);
}

TEST_F(Outputs, DashIsStandardOutput) {
  make_graph();
  for (const Words& more : {Words{}, Words{"--graph-only"}}) {
    Words words = {"compute", "mesh.off", "-o", "-", "--quiet"}, whole = {"compute", "mesh.off", "-o", "h.reeb"};
    words.insert(words.end(), more.begin(), more.end());
    whole.insert(whole.end(), more.begin(), more.end());
    whole.emplace_back("--force");
    const auto before = files();
    const Outcome outcome = reeb(words);
    expect_success(outcome);
    EXPECT_EQ(files(), before);
    expect_success(reeb(whole));
    EXPECT_EQ(outcome.output, file("h.reeb"));
    fs::remove(in_folder("h.reeb"));
  }
  EXPECT_EQ(reeb({"extract", "g.reeb", "-o", "-"}).output, reeb({"extract", "g.reeb"}).output);
  EXPECT_EQ(reeb({"pairs", "g.reeb", "-o", "-"}).output, reeb({"pairs", "g.reeb"}).output);
  // What follows in a file is not replaced.
  const Outcome appended = in_shell("echo first >out; \"$@\" >>out", {"compute", "mesh.off", "-o", "-", "--quiet"});
  expect_success(appended);
  EXPECT_EQ(file("out"), "first\n" + file("g.reeb"));
  expect_error(reeb({"compute", "mesh.off", "-o", "-", "-f", "x", "-f", "y"}), 2);
  expect_error(reeb({"compute", "mesh.off", "-o", "-", "--snapshot-every", "1"}), 2);
  expect_error(reeb({"convert", "mesh.off", "-"}), 2, "a mesh is not written to standard output");
  // From standard input the default name is mesh.reeb.
  expect_success(reeb({"compute", "-"}, {.arguments = {}, .input = in_folder("mesh.off")}));
  EXPECT_EQ(file("mesh.reeb"), file("g.reeb"));
}

TEST_F(Outputs, DevicesAndPipesAreWrittenInto) {
  if (::mknod(in_folder("null").c_str(), S_IFCHR | 0666, 259) != 0) GTEST_SKIP() << "not here: mknod needs root";
  make_graph();
  for (const Words& words : {Words{"compute", "mesh.off", "-o", "null", "--report", "null"}, Words{"pairs", "g.reeb"},
                             Words{"extract", "g.reeb", "--format", "json"}}) {
    Words all = words;
    all.insert(all.end(), {"-o", "null", "--force"});
    if (words[0] == "compute") all.erase(all.end() - 3, all.end() - 1);
    expect_success(reeb(all));
    EXPECT_TRUE(fs::is_character_file(in_folder("null"))) << last_command();
  }
  ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
  expect_success(in_shell("cat pipe >copy & \"$@\" && wait", {"compute", "mesh.off", "-o", "pipe", "--force"}));
  EXPECT_EQ(file("copy"), file("g.reeb"));
  EXPECT_TRUE(fs::is_fifo(in_folder("pipe")));
}

// ---- standard output and standard error

TEST_F(Outputs, MessagesThatCannotBeWrittenStopNoRun) {
  for (const std::string line : {"\"$@\" 2>&-", "\"$@\" 2>/dev/full", "\"$@\" 2> >(true)", "\"$@\" >&- 2>&-",
                                 "exec 2> >(exec true); sleep 0.1; \"$@\"", "\"$@\" <&- >&- 2>&-"}) {
    SCOPED_TRACE(line);
    EXPECT_EQ(in_shell(line, {"compute", "mesh.off", "-o", "a.reeb"}).exit_code, 0);
    expect_success(reeb({"verify", "a.reeb"}));
    EXPECT_EQ(in_shell(line, {"compute", "mesh.off", "-o", "a.reeb"}).exit_code, 1) << "it exists";
    EXPECT_EQ(in_shell(line, {"compute", "mesh.off", "-f", "bogus"}).exit_code, 2);
    EXPECT_EQ(in_shell(line, {"extract", "nope.reeb"}).exit_code, 1);
    EXPECT_EQ(in_shell(line, {"convert", "mesh.off", "a.ply"}).exit_code, 0);
    EXPECT_EQ(in_shell(line, {"generate", "torus", "--triangles", "100", "-o", "t.ply"}).exit_code, 0);
    for (const char* name : {"a.reeb", "a.ply", "t.ply"}) fs::remove(in_folder(name));
  }
}

TEST_F(Outputs, MessagesInAFileThatCannotGrowStopNoRun) {
  if (kSanitized) GTEST_SKIP() << "the thread sanitizer itself grows a file";
  write("log", "");
  EXPECT_EQ(in_shell("ulimit -f 0; \"$@\" 2>log", {"compute", "mesh.off"}).exit_code, 3);
  EXPECT_EQ(in_shell("ulimit -f 0; \"$@\" 2>log", {"extract", "nope.reeb"}).exit_code, 1);
}

const Words kPrinters[] = {{"pairs", "g.reeb"},
                           {"extract", "g.reeb"},
                           {"info", "g.reeb"},
                           {"info", "g.reeb", "--json"},
                           {"info", "mesh.off"},
                           {"info", "mesh.off", "--json"},
                           {"verify", "g.reeb"},
                           {"verify", "g.reeb", "--mesh", "mesh.off"},
                           {"--help"},
                           {"--version"},
                           {"pairs", "--help"},
                           {},
                           {"compute", "mesh.off", "-o", "a.reeb", "--quiet", "--report", "-"},
                           {"compute", "mesh.off", "-o", "-", "--quiet"}};

TEST_F(Outputs, AFullStandardOutputIsExitCode3) {
  make_graph();
  for (const Words& words : kPrinters)
    for (const std::string line : {"\"$@\" >/dev/full", "\"$@\" >&-"}) {
      fs::remove(in_folder("a.reeb"));
      expect_error(in_shell(line, words), 3, "standard output: cannot be written");
    }
}

TEST_F(Outputs, AServerWhoseAddressCannotBePrintedEnds) {
  if (!REEB_WEB) GTEST_SKIP() << "not here: built with REEB_WEB=OFF";
  make_graph();
  for (const char* line : {"timeout 20 \"$@\" >/dev/full", "timeout 20 \"$@\" >&-"}) {
    const Outcome outcome = in_shell(line, {"view", "g.reeb"});
    expect_error(outcome, 3, "standard output: cannot be written");
    EXPECT_EQ(outcome.error.find("-o"), std::string::npos) << outcome.error;
  }
}

TEST_F(Outputs, AClosedPipeEndsTheProgramQuietly) {
  make_graph();
  for (const Words& words : kPrinters) {
    fs::remove(in_folder("a.reeb"));
    // The reader has gone before the program starts.
    const Outcome outcome = in_shell("(sleep 0.1; \"$@\"; echo $? >code) | true", words);
    EXPECT_EQ(outcome.error, "") << last_command();
    EXPECT_EQ(file("code"), "141\n") << last_command();
  }
}

// ---- names

TEST_F(Outputs, NamesCannotBreakMessages) {
  const std::string name = "a\nb\x1b[31m\xff.off";
  write(name, "OFF\n1 0 0\n0 0 0\n");
  const std::string shown = "a\\x0ab\\x1b[31m\\xff.off";
  const Outcome outcome = reeb({"compute", name, "-o", "a.reeb", "--report", "-"});
  expect_success(outcome);
  EXPECT_NE(outcome.error.find(shown), std::string::npos) << outcome.error;
  EXPECT_EQ(outcome.error.find('\x1b'), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(outcome.output).at("input").at("vertices"), 1);
  const Outcome info = reeb({"info", name, "--json"});
  expect_success(info);
  EXPECT_EQ(nlohmann::json::parse(info.output).at("vertices"), 1);
  EXPECT_TRUE(reeb({"info", name}).output.starts_with(shown));
  expect_error(reeb({"compute", name, "-o", "a.reeb"}), 1, "a.reeb:");
  expect_error(reeb({"compute", "none\x1b.ply"}), 1, "none\\x1b.ply:");
  write("values.txt", std::string("\x93NUMPY\0\x1b", 8));
  const Outcome bad = reeb({"compute", "mesh.off", "-f", "file:values.txt"});
  expect_error(bad, 1, "values.txt:1:1:");
  EXPECT_NE(bad.error.find("\\x93NUMPY\\x00\\x1b"), std::string::npos) << bad.error;
}

// ---- limits

TEST_F(Outputs, LimitsOfTheSystemAreExplained) {
  if (kSanitized) GTEST_SKIP() << "sanitizers need open files of their own";
  expect_success(reeb({"generate", "torus", "--triangles", "1000", "-o", "t.ply"}));
  int refused = 0;
  for (int files = 4; files <= 10; ++files) {
    const Outcome outcome = in_shell("ulimit -n " + std::to_string(files) + "; exec \"$@\"",
                                     {"compute", "t.ply", "-o", "t.reeb", "--force"});
    if (outcome.exit_code == 0 || outcome.exit_code == 127) continue;  // 127: libraries are files, too
    ++refused;
    expect_error(outcome, 3);
    EXPECT_NE(outcome.error.find("Too many open files"), std::string::npos) << outcome.error;
    EXPECT_NE(outcome.error.find("ulimit -n"), std::string::npos) << outcome.error;
    EXPECT_FALSE(fs::exists(in_folder("t.reeb.partial")));
  }
  EXPECT_GT(refused, 0);
}

TEST_F(Outputs, ALimitOfTheSizeOfFilesIsNoFullDisk) {
  expect_success(reeb({"generate", "torus", "--triangles", "10k", "-o", "t.ply"}));
  const Outcome outcome = in_shell("ulimit -f 20; exec \"$@\"", {"convert", "t.ply", "o.ply"});
  expect_error(outcome, 3);
  EXPECT_NE(lines_after("hint: ", outcome.error).at(0).find("ulimit -f"), std::string::npos) << outcome.error;
}

TEST_F(Outputs, FinishedOutputsHaveTheUsualMode) {
  expect_success(in_shell("umask 027; exec \"$@\"", {"compute", "mesh.off", "--report", "r.json"}));
  for (const char* name : {"mesh.reeb", "r.json"})
    EXPECT_EQ(static_cast<unsigned>(fs::status(in_folder(name)).permissions()), 0640u) << name;
}

// ---- signals

// Starts the program with `words`, sends the signal after 0.3 s, and expects that it ends soon, with exit code 130 and
// a message.
class Signals : public Outputs {
 protected:
  Outcome interrupt(const Words& words, const std::string& signal, const std::string& input = "true") {
    const std::string script = "exec 3< <(" + input + "); \"$@\" <&3 & p=$!; sleep 0.3; a=$(date +%s%N); kill -" +
                               signal +
                               " $p; wait $p; code=$?; echo $((($(date +%s%N) - a) / 1000000)) >delay; exit $code";
    const Outcome outcome = in_shell(script, words);
    delay_ms_ = std::stoi(file("delay"));
    fs::remove(in_folder("delay"));
    return outcome;
  }

  void expect_interrupted(const Words& words, const std::string& signal, const std::string& input = "true") {
    const auto before = files();
    const Outcome outcome = interrupt(words, signal, input);
    expect_error(outcome, 130, "interrupted");
    if (!kThreadsSanitized) {
      EXPECT_LT(delay_ms_, 2000) << last_command();  // 500 on a machine that has nothing else to do
    }
    EXPECT_EQ(files(), before) << last_command();
  }

  int delay_ms_ = 0;
};

TEST_F(Signals, LeaveNothingBehind) {
  expect_success(reeb({"generate", "scan", "--triangles", "300k", "--order", "random", "-o", "m.ply"}));
  expect_success(reeb({"compute", "m.ply", "-o", "g.reeb", "-f", "random:1", "--buckets", "0", "--quiet"}));
  for (const std::string signal : {"INT", "TERM", "HUP"})
    expect_interrupted({"generate", "scan", "--triangles", "300M", "-o", "big.ply"}, signal);
  expect_interrupted({"convert", "-", "out.ply"}, "INT", "cat m.ply | (head -c 1000000; sleep 60)");
  expect_interrupted({"convert", "-", "out.smc"}, "INT", "cat m.ply | (head -c 1000000; sleep 60)");
  expect_interrupted({"info", "-"}, "TERM", "cat m.ply | (head -c 1000000; sleep 60)");
  expect_interrupted({"verify", "g.reeb", "--mesh", "-"}, "INT", "cat m.ply | (head -c 1000000; sleep 60)");
  // A pipe that nobody reads holds up the writers.
  ASSERT_EQ(::mkfifo(in_folder("pipe").c_str(), 0600), 0);
  expect_interrupted({"extract", "g.reeb", "-o", "pipe", "--format", "json"}, "INT");
}

// All is computed, and the output is a pipe that nobody reads.
TEST_F(Signals, EndCommandsThatHaveStoppedToWatchThem) {
  expect_success(reeb({"generate", "torus", "--triangles", "1k", "-o", "m.ply"}));
  expect_success(reeb({"compute", "m.ply", "-o", "g.reeb", "--quiet"}));
  for (const char* pipe : {"pipe.i64", "pipe.ply", "pipe.csv", "pipe.html"})
    ASSERT_EQ(::mkfifo(in_folder(pipe).c_str(), 0600), 0);
  expect_interrupted({"segment", "m.ply", "g.reeb", "-o", "pipe.i64"}, "INT");
  const auto with_report = [&](const std::string& output, std::vector<std::string> words) {
    words.insert(words.end(), {"-o", output, "--report", "pipe.csv", "--quiet"});
    EXPECT_EQ(interrupt(words, "INT").exit_code, 130) << last_command();
    EXPECT_TRUE(fs::remove(in_folder(output))) << last_command();  // it is whole
  };
  with_report("h.reeb", {"compute", "m.ply"});
  expect_success(reeb({"fragment", "m.ply", "--part", "1/1", "-o", "p.fragment", "--quiet"}));
  with_report("h.reeb", {"glue", "p.fragment"});
  expect_interrupted({"segment", "m.ply", "g.reeb", "-o", "pipe.ply"}, "INT");
  expect_interrupted({"defects", "m.ply", "-o", "pipe.csv"}, "INT");
  expect_interrupted({"repair", "m.ply", "-o", "pipe.ply"}, "INT");
  expect_interrupted({"report", "g.reeb", "--mesh", "m.ply", "-o", "pipe.html"}, "TERM");
}

TEST_F(Signals, AreNoticedWhileNoFaceComes) {
  expect_interrupted({"compute", "-", "-o", "y.reeb", "--quiet"}, "INT", "yes 'v 0 0 0'");
  expect_interrupted({"compute", "-", "-o", "y.reeb", "--quiet"}, "TERM", "sleep 60");
}

TEST_F(Signals, AreNoticedWhileAMeshIsSorted) {
  expect_success(reeb({"generate", "scan", "--triangles", "3M", "--order", "random", "-o", "m.ply"}));
  expect_interrupted({"compute", "m.ply", "--memory", "32M", "--quiet", "-o", "y.reeb"}, "INT");
  expect_interrupted({"convert", "m.ply", "out.ply", "--order", "hilbert", "--memory", "32M"}, "INT");
  expect_interrupted({"convert", "m.ply", "out.ply", "--order", "spectral", "--memory", "64M"}, "TERM");
}

TEST_F(Signals, AreNoticedWhileVerticesOfAFileCome) {
  expect_success(in_shell("(yes 'v 0 0 0' | head -n 30000000; echo f 1 2 3) >v.obj; true", {"--version"}));
  expect_interrupted({"compute", "v.obj", "-o", "y.reeb", "--quiet"}, "INT");
}

}  // namespace
}  // namespace reeb::test
