// Every command but `view` on a tiny mesh, with a fault in the n-th call of each kind: the files cannot be opened,
// read, written, mapped, synced or renamed, the disk is full, or memory is out. Each ends with an error that says what
// to do, leaves nothing behind, and a second run gives the right bytes. Ordinary runs skip more and more n;
// REEB_TEST_ALL=1 skips few.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/file/fault.h"
#include "io/file/zstd_codec.h"
#include "tests/support/allocation_faults.h"
#include "tests/support/files.h"
#include "tests/support/process.h"
#include "tests/support/scratch.h"
#include "tests/tools/commands_in_process.h"
#include "tools/report/report.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;
using io::FileCall;
using ooc::FaultAtCall;
using Which = FaultAtCall::Which;
using Files = std::map<std::string, std::string>;  // content by name
using Words = std::vector<std::string>;

struct TestedRun {
  std::string name;
  Words words;
  Words outputs = {};
  std::string input = "/dev/null";
  bool is_resumed = false;  // an interrupted run is there

  bool can_resume() const { return words[0] == "compute" || (words[0] == "fragment" && !names("--scan")); }
  bool names(const std::string& file) const { return std::ranges::find(words, file) != words.end(); }

  // Of a .reeb file that cannot be read the report is a page that says so.
  bool ends_otherwise_if_unreadable() const { return words[0] == "report"; }
  // The JSON library allocates while it releases memory; the process ends if it cannot.
  bool allocates_at_release() const { return names("--json") || names("--log") || words[0] == "report"; }
};

// Whether the program has pages (REEB_WEB).
bool has_pages() {
  try {
    tools::require_pages();
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::vector<TestedRun> make_commands() {
  // Without threads, the calls of a run are always the same.
  const auto compute = [](Words more, bool threads = false) {
    Words words = {"compute", "-o", "out.reeb", "--quiet", "--chunk", "9", "--threads", threads ? "2" : "1"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  std::vector<TestedRun> commands = {
      {"ComputeOne", compute({"scan.ply"}), {"out.reeb"}},
      {"ComputeTwo",
       compute({"scan.ply", "-f", "z", "-f", "x", "--denoise", "5%"}, true),
       {"out-z.reeb", "out-x.reeb"}},
      {"ComputeSidecar", compute({"scan.ply", "--sidecar"}), {"out.reeb", "scan.ply.final"}},
      {"ComputeResume", compute({"scan.ply", "--resume"}), {"out.reeb"}, "/dev/null", true},
      {"ComputeObj", compute({"scan.obj", "-f", "file:values.txt"}), {"out.reeb"}},
      {"ComputeStream", compute({"scan.smb", "-f", "file:values.f64"}), {"out.reeb"}},
      {"ComputeStandardInput", compute({"-", "--graph-only"}), {"out.reeb"}, "scan.obj"},
      {"ComputeCompressed", compute({"scan.ply.zst"}), {"out.reeb"}},
      {"ComputeGzip", compute({"scan.ply.gz"}), {"out.reeb"}},
      {"ComputeSnapshots",
       compute({"scan.smb", "--snapshot-every", "60"}),
       {"out.reeb", "out-000001.reeb", "out-000002.reeb"}},
      {"InfoOfMesh", {"info", "scan.ply"}},
      {"InfoOfMeshAsJson", {"info", "scan.ply", "--json"}},
      {"InfoOfGraph", {"info", "scan.reeb"}},
      {"Pairs", {"pairs", "scan.reeb", "-o", "pairs.csv"}, {"pairs.csv"}},
      {"PairsToStandardOutput", {"pairs", "scan.reeb"}},
      {"Plot", {"plot", "scan.reeb", "--kind", "skeleton", "--nodes", "9", "-o", "plot.svg"}, {"plot.svg"}},
      {"Generate", {"generate", "scan", "--triangles", "100", "-o", "made.smc"}, {"made.smc"}},
      {"GenerateAtRandom",
       {"generate", "torus", "--triangles", "100", "--order", "random", "-o", "made.ply"},
       {"made.ply"}},
      {"Verify", {"verify", "scan.reeb"}},
      {"VerifyMesh", {"verify", "scan.reeb", "--mesh", "scan.ply"}},
      {"ConvertSpectral", {"convert", "scan.ply", "made.ply", "--order", "spectral"}, {"made.ply"}},
      {"ConvertSweep", {"convert", "scan.obj", "made.obj", "--order", "sweep:x", "--finalize"}, {"made.obj"}},
      {"ConvertKeep", {"convert", "scan.smb", "made.off"}, {"made.off"}},
      {"ConvertEvents", {"convert", "scan.obj", "made.events.txt"}, {"made.events.txt"}},
      {"ConvertCompressed", {"convert", "scan.ply.zst", "made.smb", "--finalize"}, {"made.smb"}},
      {"Function", {"function", "scan.ply", "-f", "x", "-o", "values.npy"}, {"values.npy"}},
      {"FunctionToMesh", {"function", "scan.ply", "-f", "geodesic:0", "-o", "made.ply"}, {"made.ply"}},
      {"Segment", {"segment", "scan.ply", "scan.reeb", "-o", "labels.i64", "--threads", "1"}, {"labels.i64"}},
      {"SegmentToMesh",
       {"segment", "scan.ply", "scan.reeb", "--nodes", "9", "-o", "labels.vtu", "--threads", "1"},
       {"labels.vtu"}},
      {"Defects", {"defects", "ring.ply", "ring.reeb", "-o", "defects.csv", "--threads", "1"}, {"defects.csv"}},
      {"Repair",
       {"repair", "ring.ply", "--all", "-o", "made.ply", "--log", "log.json", "--undo", "undo", "--threads", "1"},
       {"made.ply", "log.json", "undo"}},
      {"RepairUndone", {"repair", "clean.ply", "--apply-undo", "clean.undo", "-o", "made.ply"}, {"made.ply"}},
      {"Fragment",
       {"fragment", "scan.ply", "--part", "1/2", "-o", "p.fragment", "--chunk", "9", "--threads", "1", "--quiet"},
       {"p.fragment"}},
      {"FragmentNames",
       {"fragment", "scan.ply", "--scan", "--part", "2/2", "-o", "p.names", "--threads", "1"},
       {"p.names"}},
      {"Glue", {"glue", "1.fragment", "2.fragment", "-o", "glued.reeb", "--threads", "1", "--quiet"}, {"glued.reeb"}},
      {"GlueToFragment", {"glue", "1.fragment", "-o", "half.fragment", "--threads", "1"}, {"half.fragment"}},
  };
  if (has_pages())
    commands.push_back({"Report",
                        {"report", "ring.reeb", "--mesh", "ring.ply", "-o", "report.html", "--threads", "1"},
                        {"report.html"}});
  for (const char* suffix : {"ply", "obj", "off", "sma", "smb", "smc", "events.txt"}) {
    const std::string made = std::string("made.") + suffix;
    commands.push_back({std::string("ConvertHilbert_") + std::string(suffix).substr(0, 3),
                        {"convert", "scan.ply", made, "--order", "hilbert"},
                        {made}});
  }
  for (const char* suffix : {"sva", "svb"}) {
    const std::string made = std::string("made.") + suffix;
    commands.push_back({std::string("ConvertTetrahedra_") + suffix, {"convert", "solid.sva", made}, {made}});
  }
  for (const char* format : {"rg", "json", "csv", "dot", "graphml", "vtp", "vtu", "ply", "obj", "swc", "gltf"}) {
    const std::string made = std::string("level.") + format;
    if (made == "level.csv") {
      commands.push_back(
          {"Extract_csv", {"extract", "scan.reeb", "--nodes", "9", "-o", made}, {"level.nodes.csv", "level.arcs.csv"}});
      continue;
    }
    commands.push_back(
        {std::string("Extract_") + format, {"extract", "scan.reeb", "--nodes", "9", "-o", made}, {made}});
  }
  return commands;
}

const std::vector<TestedRun>& all_commands() {
  static const auto* const commands = new std::vector<TestedRun>(make_commands());
  return *commands;
}

std::vector<std::size_t> numbers_of_commands(bool with_allocations_at_release) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < all_commands().size(); ++i)
    if (with_allocations_at_release || !all_commands()[i].allocates_at_release()) numbers.push_back(i);
  return numbers;
}

struct FaultKind {
  const char* name;
  FileCall call;
  int error;
  Which which;
};
constexpr FaultKind kFileFaults[] = {
    {"open", FileCall::kOpen, EMFILE, Which::kOne},
    {"read", FileCall::kRead, EIO, Which::kOne},
    {"write", FileCall::kWrite, EIO, Which::kOne},
    {"full disk", FileCall::kWrite, ENOSPC, Which::kAllFrom},
    {"map", FileCall::kMap, ENOMEM, Which::kOne},
    {"sync", FileCall::kSync, EIO, Which::kOne},
    {"full disk at sync", FileCall::kSync, ENOSPC, Which::kAllFrom},
    {"rename", FileCall::kRename, EIO, Which::kOne},
};

std::size_t open_descriptors() {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

// A folder of inputs, and one for temporary files.
class CommandFaults : public testing::TestWithParam<std::size_t> {
 protected:
  const TestedRun& command() const { return all_commands()[GetParam()]; }

  void SetUp() override {
    before_ = fs::current_path();
    fs::current_path(folder_.path());
    ::setenv("TMPDIR", temp_.path().c_str(), 1);
    ::setenv("REEB_CHECKPOINT_SECONDS", "0", 1);
    make_inputs();
    expected_ = succeed(command());
    ASSERT_FALSE(HasFailure());
    if (command().is_resumed) interrupted_ = interrupted_run();
  }
  void TearDown() override {
    ::unsetenv("REEB_CHECKPOINT_SECONDS");
    ::setenv("TMPDIR", "/dev/shm", 1);
    fs::current_path(before_);
  }

  // The command with this fault in call n. Returns whether there was an n-th call.
  bool try_file_fault(const FaultKind& kind, std::uint64_t n) {
    const FaultAtCall fault(kind.call, n, {.error = kind.error}, kind.which);
    check(std::string(kind.name) + " " + std::to_string(n), false, [&](const auto& work) {
      const io::ScopedFileFaults faults(fault);
      work();
    });
    return fault.count() >= n;
  }
  bool try_allocation_fault(std::uint64_t n) {
    std::uint64_t count = 0;
    check("allocation " + std::to_string(n), true, [&](const auto& work) {
      struct Counter {
        std::uint64_t& count;
        ScopedAllocationFault fault;
        ~Counter() { count = fault.count(); }
      } const counter{count, ScopedAllocationFault(n)};
      work();
    });
    return count >= n;
  }

  // All files, temporary ones and those in folders included.
  Files files() const {
    Files found;
    for (const std::string& root : {folder_.path(), temp_.path()})
      for (const auto& entry : fs::recursive_directory_iterator(root))
        found[(root == temp_.path() ? "temporary " : "") + entry.path().lexically_relative(root).string()] =
            entry.is_directory() ? "(folder)" : read_file(entry.path());
    return found;
  }

  // What a run without faults writes, standard output included; then the folder is as before.
  Files succeed(const TestedRun& c, Words more = {}) {
    Words words = c.words;
    words.insert(words.end(), more.begin(), more.end());
    const CommandOutcome outcome = run_command(words, c.input);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.file << ": " << outcome.message;
    return take_outputs(outcome.output);
  }

  template <class Around>
  void expect_success(const Around& around) {
    restore_interrupted_run();
    const CommandOutcome outcome = run_command(command().words, command().input, around);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.file << ": " << outcome.message;
    expect_same(take_outputs(outcome.output));
  }

 private:
  void make_inputs() {
    const auto make = [](Words words) {
      const CommandOutcome outcome = run_command(words);
      ASSERT_EQ(outcome.exit_code, 0) << words[0] << ": " << outcome.file << ": " << outcome.message;
    };
    make({"generate", "scan", "--triangles", "150", "--order", "random", "-o", "scan.ply"});
    make({"convert", "scan.ply", "scan.obj"});
    make({"convert", "scan.ply", "scan.smb", "--finalize"});
    make({"compute", "scan.ply", "-o", "scan.reeb", "--quiet"});
    write_file("solid.sva", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nc 1 2 3 4\nv 1 1 1\nc 2 3 4 5\n");
    const std::string mesh = read_file("scan.ply");
    std::vector<std::byte> packed;
    io::zstd_compress(std::as_bytes(std::span(mesh)), 1, packed);
    write_file("scan.ply.zst", {reinterpret_cast<const char*>(packed.data()), packed.size()});
    ASSERT_EQ(std::system("gzip -k scan.ply"), 0);
    if (command().names("1.fragment")) {
      make({"fragment", "scan.ply", "--part", "1/2", "-o", "1.fragment", "--quiet"});
      make({"fragment", "scan.ply", "--part", "2/2", "-o", "2.fragment", "--quiet"});
    }
    if (command().names("ring.ply") || command().names("clean.ply"))
      make({"generate", "torus", "--triangles", "100", "-o", "ring.ply"});
    if (command().names("ring.reeb")) make({"compute", "ring.ply", "-o", "ring.reeb", "--quiet"});
    if (command().names("clean.ply"))
      make({"repair", "ring.ply", "--all", "-o", "clean.ply", "--undo", "clean.undo", "--quiet"});
    std::string text, raw;
    const std::string json = run_command({"info", "scan.ply", "--json"}).output;
    const auto at = json.find("\"vertices\": ");
    ASSERT_NE(at, std::string::npos) << json;
    const int count = std::atoi(json.c_str() + at + 12);
    ASSERT_GT(count, 10);
    for (int i = 0; i < count; ++i) {
      const double value = i * 7 % 31;
      text += std::to_string(value) + "\n";
      raw.append(reinterpret_cast<const char*>(&value), sizeof(value));
    }
    write_file("values.txt", text);
    write_file("values.f64", raw);
    inputs_ = files();
  }

  // The files of a run that ended in the middle: its eighth checkpoint was its last.
  Files interrupted_run() {
    (void)run_command(command().words, command().input, [](const auto& work) {
      const io::ScopedFileFaults faults(FaultAtCall(FileCall::kWrite, 9, {.error = ENOSPC}));
      work();
    });
    Files left = files();
    for (const auto& [name, content] : inputs_) left.erase(name);
    EXPECT_TRUE(left.contains("out.reeb.partial/checkpoint"));
    fs::remove_all("out.reeb.partial");
    return left;
  }

  void restore_interrupted_run() {
    if (interrupted_.empty()) return;
    fs::create_directory("out.reeb.partial");
    fs::permissions("out.reeb.partial", fs::perms::owner_all);
    for (const auto& [name, content] : interrupted_)
      if (content != "(folder)") write_file(name, content);
  }

  Files take_outputs(const std::string& standard_output) {
    Files outputs;
    for (const auto& [name, content] : files()) {
      const auto input = inputs_.find(name);
      if (input != inputs_.end()) {
        EXPECT_EQ(content == input->second, true) << "the input " << name << " was changed";
        continue;
      }
      outputs[name] = content;
      fs::remove_all(name);
    }
    outputs["standard output"] = standard_output;
    return outputs;
  }

  void expect_same(const Files& outputs) {
    for (const auto& [name, content] : outputs)
      EXPECT_TRUE(expected_.contains(name) && expected_.at(name) == content) << name << " has the wrong bytes";
    for (const auto& [name, content] : expected_) EXPECT_TRUE(outputs.contains(name)) << "no " << name;
  }

  template <class Around>
  void check(const std::string& what, bool is_allocation, const Around& around) {
    SCOPED_TRACE(what);
    restore_interrupted_run();
    const std::size_t descriptors = open_descriptors();
    const CommandOutcome outcome = run_command(command().words, command().input, around);
    EXPECT_EQ(open_descriptors(), descriptors) << "descriptors stay open";
    if (outcome.exit_code == 0) return expect_same(take_outputs(outcome.output));

    SCOPED_TRACE(outcome.file + ": " + outcome.message + "; hint: " + outcome.hint);
    // A bad file is one that the user named.
    const bool names_input = inputs_.contains(outcome.file) || outcome.file == "standard input";
    EXPECT_TRUE(outcome.exit_code == 3 || (outcome.exit_code == 1 && names_input)) << outcome.exit_code;
    EXPECT_TRUE(is_allocation || !outcome.file.empty());
    EXPECT_TRUE(!is_allocation || outcome.exit_code == 3) << "the input is not what failed";
    EXPECT_FALSE(outcome.message.empty());
    EXPECT_GT(outcome.hint.size(), 10u);
    const bool resumable = outcome.hint.find("--resume") != std::string::npos;
    EXPECT_TRUE(!resumable || fs::exists(command().outputs[0] + ".partial/checkpoint"));
    // An interrupted run stays where its folder was not opened yet.
    const bool may_keep = resumable || command().is_resumed;
    for (const auto& [name, content] : files()) {
      if (inputs_.contains(name) || (may_keep && name.starts_with(command().outputs[0] + ".partial"))) continue;
      // What was finished stays.
      EXPECT_TRUE(expected_.contains(name) && expected_.at(name) == content) << name << " was left";
    }
    if (command().can_resume()) {
      for (const std::string& output : command().outputs) fs::remove(output);
      expect_same(succeed(command(), {"--resume"}));
    } else {
      for (const std::string& output : command().outputs) fs::remove(output);
      expect_same(succeed(command()));
    }
  }

  ooc::Scratch folder_, temp_;
  fs::path before_;
  Files inputs_, expected_, interrupted_;
};

const bool kAll = std::getenv("REEB_TEST_ALL") != nullptr;

TEST_P(CommandFaults, EachFileFaultIsReportedAndLeavesNothing) {
  for (const FaultKind& kind : kFileFaults) {
    if (kind.call == FileCall::kRead && command().ends_otherwise_if_unreadable()) continue;
    for (std::uint64_t n = 1; try_file_fault(kind, n) && !HasFailure(); n += kAll ? 1 : 1 + n / 16) {
    }
  }
}

class CommandAllocationFaults : public CommandFaults {};

TEST_P(CommandAllocationFaults, EachIsReportedAndLeavesNothing) {
  for (std::uint64_t n = 1; try_allocation_fault(n) && !HasFailure(); n += 1 + n / (kAll ? 256 : 16)) {
  }
}

TEST_P(CommandFaults, InterruptedCallsAreRepeated) {
  std::atomic<std::uint64_t> calls = 0;
  expect_success([&](const auto& work) {
    const io::ScopedFileFaults faults(
        [&calls](FileCall) { return ++calls % 3 != 0 ? io::FileFault{.error = EINTR} : io::FileFault{}; });
    work();
  });
  EXPECT_GT(calls, 3u);
}

TEST_P(CommandFaults, ShortTransfersAreContinued) {
  std::atomic<std::uint64_t> calls = 0;
  expect_success([&](const auto& work) {
    const io::ScopedFileFaults faults([&calls](FileCall) { return io::FileFault{.most_bytes = 1 + ++calls % 77}; });
    work();
  });
}

INSTANTIATE_TEST_SUITE_P(Commands, CommandFaults, testing::ValuesIn(numbers_of_commands(true)),
                         [](const auto& one) { return all_commands()[one.param].name; });
INSTANTIATE_TEST_SUITE_P(Commands, CommandAllocationFaults, testing::ValuesIn(numbers_of_commands(false)),
                         [](const auto& one) { return all_commands()[one.param].name; });

// `view` serves until a signal ends it.
TEST(TestedCommands, AreThoseOfTheHelpButView) {
  const std::string help = run_process({.arguments = {REEB_PROGRAM}}).output;
  std::set<std::string> expected, tested;
  const std::regex command("\n  ([a-z]+) +[A-Z]");
  for (std::sregex_iterator it(help.begin(), help.end(), command), end; it != end; ++it) expected.insert((*it)[1]);
  EXPECT_EQ(expected.erase("view"), 1u) << help;
  if (!has_pages()) expected.erase("report");
  for (const TestedRun& run : all_commands()) tested.insert(run.words[0]);
  EXPECT_EQ(tested, expected);
}

// Another program makes one of the tables, or both, just before the first of ours gets its name.
TEST(TakenNames, BothTablesAreKept) {
  const ooc::Scratch folder;
  const auto path = [&](const std::string& name) { return folder.path() + "/" + name; };
  ASSERT_EQ(run_command({"generate", "torus", "--triangles", "200", "-o", path("t.ply")}).exit_code, 0);
  ASSERT_EQ(run_command({"compute", path("t.ply"), "-o", path("g.reeb"), "--quiet"}).exit_code, 0);
  ASSERT_EQ(run_command({"extract", path("g.reeb"), "-o", path("good.csv")}).exit_code, 0);
  const Words all = {"nodes", "arcs"};
  for (const Words& taken : {Words{"nodes"}, Words{"arcs"}, all}) {
    const auto is_taken = [&](const std::string& table) { return std::ranges::count(taken, table) != 0; };
    SCOPED_TRACE(taken.size() == 2 ? "both" : taken[0]);
    const CommandOutcome outcome =
        run_command({"extract", path("g.reeb"), "-o", path("g.csv")}, "/dev/null", [&](const auto& work) {
          const io::ScopedFileFaults faults([&](FileCall call) {
            if (call == FileCall::kRename)
              for (const std::string& table : taken) write_file(path("g." + table + ".csv"), "precious");
            return io::FileFault{};
          });
          work();
        });
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.file, path("g." + taken[0] + ".csv"));
    for (const std::string& table : all) {
      const std::string name = path("g." + table + ".csv"), ours = is_taken(table) ? name + ".2" : name;
      EXPECT_EQ(read_file(ours), read_file(path("good." + table + ".csv")));
      EXPECT_EQ(outcome.message.find(ours) != std::string::npos, is_taken(table)) << outcome.message;
      if (is_taken(table)) {
        EXPECT_EQ(read_file(name), "precious");
        fs::remove(name);
      }
      fs::remove(ours);
    }
  }
}

// The outputs are synced to disk, which takes most of the time of such small runs elsewhere.
const bool kScratchIsInMemory = ::access("/dev/shm", W_OK) == 0 && ::setenv("TMPDIR", "/dev/shm", 1) == 0;

}  // namespace
}  // namespace reeb::test
