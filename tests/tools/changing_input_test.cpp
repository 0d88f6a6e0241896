// Inputs that change while they are read, and sidecars of other content: no wrong graph, no crash.
#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "io/formats/open_mesh.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "tests/support/seed.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;

class ChangingInput : public ProgramTest {
 protected:
  using Change = std::function<void()>;

  void SetUp() override {
    expect_success(reeb({"generate", "scan", "--triangles", "60k", "--order", "random", "-o", "first.ply"}));
    expect_success(
        reeb({"generate", "scan", "--triangles", "60k", "--order", "random", "--seed", "9", "-o", "second.ply"}));
    first_ = file("first.ply");
    second_ = file("second.ply");
    second_.resize(first_.size(), '\0');
    write("second.ply", second_);
  }

  void put_mesh(const std::string& bytes) {
    fs::remove(in_folder("mesh.ply"));
    write("mesh.ply", bytes);
  }
  // Writes to the file that has the name now.
  void overwrite(std::size_t at, const std::string& bytes) {
    const int descriptor = ::open(in_folder("mesh.ply").c_str(), O_WRONLY);
    ASSERT_EQ(::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(at)),
              static_cast<ssize_t>(bytes.size()));
    ::close(descriptor);
  }

  // Runs the program on mesh.ply, which changes at some time.
  Outcome run_while(const std::vector<std::string>& words, double seconds, const Change& change) {
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
      change();
    });
    const Outcome outcome = reeb(words);
    other.join();
    return outcome;
  }

  // The bytes of the graph of either mesh; empty if it has none.
  std::string graph_of(const std::string& mesh) {
    put_mesh(mesh);
    const Outcome outcome = reeb(words_);
    std::string bytes = outcome.exit_code == 0 ? file("out.reeb") : "";
    fs::remove(in_folder("out.reeb"));
    return bytes;
  }

  // Exit code 0 only with the graph of one of the two; else exit code 1.
  void expect_sound(const Change& change, const std::string& changed) {
    put_mesh(first_);
    const auto begin = std::chrono::steady_clock::now();
    const std::string of_first = graph_of(first_), of_changed = graph_of(changed);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 2;
    ASSERT_NE(of_first, "");
    std::mt19937_64 random(base_seed());
    for (std::uint64_t n = 0; n < case_count(6); ++n) {
      put_mesh(first_);
      const double when = seconds * static_cast<double>(random() % 1000) / 1000;
      const Outcome outcome = run_while(words_, when, change);
      SCOPED_TRACE(testing::Message() << "after " << when << " s: " << outcome.error);
      if (outcome.exit_code == 0) {
        const std::string graph = file("out.reeb");
        EXPECT_TRUE(graph == of_first || (graph == of_changed && !graph.empty()));
      } else {
        EXPECT_EQ(outcome.exit_code, 1);
      }
      fs::remove(in_folder("out.reeb"));
    }
  }

  std::vector<std::string> words_ = {"compute",      "mesh.ply", "--buckets", "0",
                                     "--no-reorder", "-o",       "out.reeb",  "--quiet"};
  std::string first_, second_;
};

TEST_F(ChangingInput, AMeshThatIsReplaced) {
  expect_sound(
      [&] {
        fs::copy_file(in_folder("second.ply"), in_folder("new.ply"), fs::copy_options::overwrite_existing);
        fs::rename(in_folder("new.ply"), in_folder("mesh.ply"));
      },
      second_);
}

TEST_F(ChangingInput, AMeshThatIsWrittenTo) {
  const std::size_t at = second_.size() / 3;
  expect_sound([&] { overwrite(at, second_.substr(at)); }, first_.substr(0, at) + second_.substr(at));
}

TEST_F(ChangingInput, AMeshThatIsCut) {
  const std::size_t size = first_.size() / 2;
  expect_sound([&] { fs::resize_file(in_folder("mesh.ply"), size); }, first_.substr(0, size));
}

TEST_F(ChangingInput, AMeshThatIsSortedOnDisk) {
  words_.erase(std::find(words_.begin(), words_.end(), "--no-reorder"));
  expect_sound([&] { overwrite(0, second_); }, second_);
}

TEST_F(ChangingInput, AMeshWithoutItsNameIsReadToTheEnd) {
  put_mesh(first_);
  const Outcome outcome = run_while(words_, 0.05, [&] { fs::remove(in_folder("mesh.ply")); });
  EXPECT_TRUE(outcome.exit_code == 0 || outcome.error.find("o such file") != std::string::npos) << outcome.error;
}

TEST_F(ChangingInput, OtherCommandsNoticeItToo) {
  put_mesh(first_);
  expect_success(reeb({"compute", "mesh.ply", "-o", "kept.reeb", "--quiet"}));
  const std::vector<std::vector<std::string>> commands = {
      {"info", "mesh.ply"},
      {"convert", "mesh.ply", "out.ply", "--force", "--quiet"},
      {"convert", "mesh.ply", "out.smc", "--force", "--quiet"},
      {"verify", "kept.reeb", "--mesh", "mesh.ply"},
  };
  for (const auto& words : commands)
    for (const bool cut : {false, true}) {
      put_mesh(first_);
      const Outcome outcome = run_while(words, 0.03, [&] {
        if (cut)
          fs::resize_file(in_folder("mesh.ply"), first_.size() / 2);
        else
          overwrite(first_.size() / 2, second_.substr(first_.size() / 2));
      });
      EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1) << words[0] << ' ' << outcome.error;
    }
}

TEST_F(ChangingInput, AFileOfValuesThatChanges) {
  std::string values, others;
  for (int i = 0; i < 40000; ++i) {
    values += std::to_string(i % 977) + "\n";
    others += std::to_string(i % 983) + "\n";
  }
  put_mesh(first_);
  const Outcome info = reeb({"info", "mesh.ply", "--json"});
  const std::size_t at = info.output.find("\"vertices\": ");
  ASSERT_NE(at, std::string::npos);
  const int vertices = std::stoi(info.output.substr(at + 12));
  values = others = {};
  for (int i = 0; i < vertices; ++i) {
    values += std::to_string(1000 + i % 977) + "\n";
    others += std::to_string(1000 + i % 983) + "\n";
  }
  words_.insert(words_.end(), {"-f", "file:values.txt"});
  write("values.txt", others);
  const std::string of_others = graph_of(first_);
  write("values.txt", values);
  const std::string of_values = graph_of(first_);
  put_mesh(first_);
  std::mt19937_64 random(base_seed());
  for (std::uint64_t n = 0; n < case_count(6); ++n) {
    write("values.txt", values);
    const Outcome outcome =
        run_while(words_, static_cast<double>(random() % 200) / 1000, [&] { write("values.txt", others); });
    SCOPED_TRACE(outcome.error);
    ASSERT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 1);
    if (outcome.exit_code == 0) {
      const std::string graph = file("out.reeb");
      EXPECT_TRUE(graph == of_values || graph == of_others);
    }
    fs::remove(in_folder("out.reeb"));
  }
}

// ---- sidecars

class Sidecar : public ProgramTest {
 protected:
  void SetUp() override {
    expect_success(reeb({"generate", "scan", "--triangles", "200k", "-o", "mesh.ply"}));
    expected_ = graph({});
  }
  // A part reads its own triangles only. The digest of the mesh is of 16 samples of 64 KiB. Triangles of the first of
  // three parts and the last one are exchanged between them; size and time stay.
  void exchange_triangles_between_samples() {
    const fs::path path = in_folder("mesh.ply");
    const auto time = fs::last_write_time(path);
    std::string bytes = file("mesh.ply");
    constexpr std::size_t kFace = 13, kSample = 1 << 16, kSteps = 15;
    const std::size_t faces = io::open_mesh(path)->indexed()->triangles_by_size().value();
    const std::size_t begin = bytes.size() - faces * kFace, room = bytes.size() - kSample;
    const auto face_after_sample = [&](std::size_t k) {
      const std::size_t gap = room * k / kSteps + kSample + 1000;
      return bytes.begin() + static_cast<std::ptrdiff_t>(begin + (gap - begin) / kFace * kFace);
    };
    std::swap_ranges(face_after_sample(7), face_after_sample(7) + 50 * kFace, face_after_sample(13));
    write("mesh.ply", bytes);
    fs::last_write_time(path, time);
  }
  std::string graph(const std::vector<std::string>& options) {
    std::vector<std::string> words = {"compute", "mesh.ply", "--buckets", "0", "-o", "out.reeb", "--force"};
    words.insert(words.end(), options.begin(), options.end());
    outcome_ = reeb(words);
    expect_success(outcome_);
    return outcome_.exit_code == 0 ? file("out.reeb") : "";
  }

  // Writes the sidecar of mesh.ply after `lie` changed it.
  using Lie = std::function<void(ooc::UseSummary&, std::vector<std::uint32_t>&)>;
  void save(const Lie& lie) {
    const std::string path = in_folder("mesh.ply");
    MemoryBudget budget;
    const io::TempDir temp(temp_folder());
    const auto mesh = io::open_mesh(path)->indexed();
    std::optional<ooc::LastUse> truth = ooc::scan_last_use(*mesh, temp, budget);
    ooc::UseSummary summary = truth->summary();
    std::vector<std::uint32_t> entries(summary.vertex_count);
    truth->read(VertexId(0), entries);
    lie(summary, entries);
    ooc::PagedTable<std::uint32_t> table("last uses", temp, budget, 1 << 20, ooc::UseEntry::kUnused);
    table.write(0, entries);
    ooc::LastUse lies(summary, std::move(table));
    ooc::save_sidecar(path + ".final", ooc::identify_mesh(path), lies);
  }

  std::string expected_;
  Outcome outcome_;
};

TEST_F(Sidecar, OfTheMeshIsUsed) {
  save([](auto&, auto&) {});
  EXPECT_TRUE(graph({}) == expected_);
  EXPECT_EQ(outcome_.error.find("is ignored"), std::string::npos) << outcome_.error;
}

TEST_F(Sidecar, ThatLiesIsIgnored) {
  using ooc::UseEntry;
  using Entries = std::vector<std::uint32_t>;
  const auto every = [](std::size_t step, auto change) {
    return Lie([=](ooc::UseSummary& summary, Entries& entries) {
      for (std::size_t i = step / 2; i < entries.size(); i += step) entries[i] = change(UseEntry(entries[i]), summary);
      summary.unused_vertices = 0;
      for (const std::uint32_t entry : entries) summary.unused_vertices += UseEntry(entry).unused() ? 1u : 0u;
    });
  };
  const auto promise = [](std::uint64_t block_triangles) {
    return Lie([=](ooc::UseSummary& summary, Entries&) {
      summary.block_triangles = block_triangles, summary.block_count = UseEntry::kMostBlocks;
      summary.triangle_count = block_triangles * summary.block_count;
    });
  };
  const std::vector<std::pair<std::string, Lie>> lies = {
      {"unused", every(1, [](UseEntry, auto&) { return UseEntry::kUnused; })},
      {"some unused", every(977, [](UseEntry, auto&) { return UseEntry::kUnused; })},
      {"zero", every(1, [](UseEntry, auto&) { return UseEntry(0, 0).packed(); })},
      {"early",
       every(50, [](UseEntry e, auto&) { return UseEntry(e.last_block() - (e.last_block() > 0), 0).packed(); })},
      {"late", every(50,
                     [](UseEntry e, auto& s) {
                       const auto last = static_cast<std::uint32_t>(s.block_count - 1);
                       return UseEntry(std::min(e.last_block() + 1, last),
                                       std::min(e.last_block() + 1, last) - (e.last_block() - e.span()))
                           .packed();
                     })},
      {"last",
       every(1,
             [](UseEntry, auto& s) {
               return UseEntry(static_cast<std::uint32_t>(s.block_count - 1), UseEntry::kSaturatedSpan).packed();
             })},
      {"short", every(10, [](UseEntry e, auto&) { return UseEntry(e.last_block(), 0).packed(); })},
      {"triangles", [](ooc::UseSummary& s, Entries&) { s.triangle_count -= 3; }},
      {"digest", [](ooc::UseSummary& s, Entries&) { ++s.digest; }},
      {"degenerate", [](ooc::UseSummary& s, Entries&) { s.degenerate_triangles = s.triangle_count + 1; }},
      {"front", [](ooc::UseSummary& s, Entries&) { s.max_live_vertices = s.vertex_count + 1; }},
      {"blocks", [](ooc::UseSummary& s, Entries&) { s.block_triangles = s.triangle_count, s.block_count = 1; }},
      {"more triangles than address space can hold", promise(std::uint64_t{1} << 40)},
      {"more triangles than memory can hold", promise(std::uint64_t{1} << 26)},
  };
  for (const auto& [name, lie] : lies) {
    SCOPED_TRACE(name);
    save(lie);
    EXPECT_TRUE(graph({}) == expected_);
    EXPECT_NE(outcome_.error.find("mesh.ply.final is ignored, since "), std::string::npos) << outcome_.error;
    if (name.starts_with("more triangles")) {
      EXPECT_LT(outcome_.peak_rss_bytes, 200u << 20);
    }
  }
  // What only memory depends on.
  save([](ooc::UseSummary& s, Entries&) { s.max_live_vertices = 0; });
  EXPECT_TRUE(graph({}) == expected_);
}

TEST_F(Sidecar, OfAMeshThatWasChangedIsIgnored) {
  expect_success(reeb({"compute", "mesh.ply", "-o", "first.reeb", "--sidecar", "--quiet"}));
  // Triangles far apart are exchanged; size and time stay.
  const fs::path path = in_folder("mesh.ply");
  const auto time = fs::last_write_time(path);
  std::string bytes = file("mesh.ply");
  constexpr std::ptrdiff_t kFace = 13;
  std::swap_ranges(bytes.end() - 100 * kFace, bytes.end() - 50 * kFace, bytes.end() - 20'000 * kFace);
  write("mesh.ply", bytes);
  fs::last_write_time(path, time);
  fs::rename(in_folder("mesh.ply.final"), in_folder("kept"));
  const std::string expected = graph({});
  fs::rename(in_folder("kept"), in_folder("mesh.ply.final"));
  EXPECT_TRUE(graph({}) == expected);
  EXPECT_NE(outcome_.error.find("is ignored, since"), std::string::npos) << outcome_.error;
  // It is made again on request.
  EXPECT_TRUE(graph({"--sidecar"}) == expected);
  EXPECT_TRUE(graph({}) == expected);
  EXPECT_EQ(outcome_.error.find("is ignored"), std::string::npos) << outcome_.error;
}

TEST_F(Sidecar, OfOtherContentEndsAFragment) {
  expect_success(reeb({"compute", "mesh.ply", "-o", "first.reeb", "--sidecar", "--quiet"}));
  exchange_triangles_between_samples();
  for (const std::string part : {"1", "2", "3"}) {
    const Outcome outcome = reeb({"fragment", "mesh.ply", "--part", part + "/3", "-o", part + ".fragment", "--quiet"});
    if (part == "2")
      expect_success(outcome);
    else
      expect_error(outcome, 1, "mesh.ply: the sidecar ");
  }
}

TEST_F(Sidecar, NamesOfOtherContentEndAFragment) {
  const auto fragment = [&](const std::string& part, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"fragment", "mesh.ply", "--part", part + "/3", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return reeb(words);
  };
  for (const std::string part : {"1", "2", "3"}) expect_success(fragment(part, {"--scan", "-o", part + ".names"}));
  exchange_triangles_between_samples();
  for (const std::string part : {"1", "2", "3"}) {
    const Outcome outcome = fragment(part, {"-o", part + ".fragment", "--shared", "1.names", "2.names", "3.names"});
    if (part == "2")
      expect_success(outcome);
    else
      expect_error(outcome, 1, "mesh.ply: the files of names are of other content than the mesh");
  }
}

// ---- small things

TEST_F(ProgramTest, AnEmptyFileOfValuesIsThatOfAMeshWithoutVertices) {
  write("empty.off", "OFF\n0 0 0\n");
  write("mesh.off", kSmallOff);
  for (const char* name : {"values.txt", "values.f64"}) {
    write(name, "");
    expect_success(reeb({"compute", "empty.off", "-f", std::string("file:") + name, "-o", "out.reeb", "--force"}));
    expect_error(
        reeb({"compute", "mesh.off", "-f", std::string("file:") + name, "-o", "out.reeb", "--force", "--quiet"}), 1,
        std::string(name) + ":0: the file is empty");
  }
}

TEST_F(ProgramTest, TooFewFilesThatMayBeOpenAreNotBlamedOnTheInput) {
  write("mesh.off", kSmallOff);
  int refused = 0;
  for (int files = 3; files < 8; ++files) {
    Command command;
    command.wrapper = {"bash", "-c", "ulimit -n " + std::to_string(files) + "; exec \"$@\"", "-"};
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"info", "mesh.off"}, {"compute", "mesh.off", "-o", "out.reeb", "--force"}}) {
      const Outcome outcome = reeb(words, command);
      EXPECT_EQ(outcome.error.find("name a file that exists"), std::string::npos) << files << ": " << outcome.error;
      EXPECT_EQ(outcome.error.find("choose a folder"), std::string::npos) << files << ": " << outcome.error;
      if (kSanitized || outcome.exit_code == 0 || outcome.exit_code == 127) continue;  // 127: libraries are files, too
      expect_error(outcome, 3);
      ++refused;
    }
  }
  EXPECT_TRUE(kSanitized || refused > 0);
}

TEST_F(ProgramTest, InfoNeedsNoFolderThatCanBeWritten) {
  write("mesh.off", kSmallOff);
  // Not even root can write to /proc.
  const Outcome outcome = run_process(
      {.arguments = {REEB_PROGRAM, "info", in_folder("mesh.off")}, .folder = "/proc", .environment = {{"TMPDIR", ""}}});
  expect_success(outcome);
}

}  // namespace
}  // namespace reeb::test
