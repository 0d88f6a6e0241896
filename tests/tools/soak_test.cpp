// Many random meshes in one process, each computed, interrupted and resumed, verified, extracted and converted: memory
// and open files stay flat. tests/soak.sh runs it for long.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "io/file/fault.h"
#include "tests/support/files.h"
#include "tests/support/inputs/complex.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/random.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"
#include "tests/tools/commands_in_process.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;
using io::FileCall;
using ooc::FaultAtCall;

// Vertices, edges and triangles: what a mesh in a file can have.
std::string obj_of(const Complex& complex) {
  std::ostringstream text;
  for (const auto& [x, y, z] : complex.positions) text << "v " << x << ' ' << y << ' ' << z << '\n';
  for (const auto& corners : complex.simplices) {
    if (corners.size() < 2) continue;
    text << (corners.size() == 2 ? 'l' : 'f');
    for (std::size_t i = 0; i < std::min<std::size_t>(corners.size(), 3); ++i) text << ' ' << corners[i] + 1;
    text << '\n';
  }
  return text.str();
}

std::string values_of(const Complex& complex) {
  std::string raw;
  for (const double value : complex.values) raw.append(reinterpret_cast<const char*>(&value), sizeof(value));
  return raw;
}

struct Held {
  std::uint64_t resident_bytes = 0;
  std::size_t descriptors = 0;
};

Held held_now() {
  ::malloc_trim(0);
  std::uint64_t pages = 0;
  std::ifstream statm("/proc/self/statm");
  statm >> pages >> pages;
  return {pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)),
          static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()))};
}

class Soak : public testing::Test {
 protected:
  void SetUp() override { fs::current_path(folder_.path()); }
  void TearDown() override { fs::current_path(before_); }

  void run(std::vector<std::string> words, int exit_code = 0) {
    const CommandOutcome outcome = run_command(words);
    EXPECT_EQ(outcome.exit_code, exit_code) << words[0] << ": " << outcome.file << ": " << outcome.message;
  }

  // A run that a full disk ends, unless it needs fewer writes, and one that continues it.
  void resume(const std::vector<std::string>& words, std::uint64_t full_at) {
    const CommandOutcome outcome = run_command(words, "/dev/null", [full_at](const auto& work) {
      const io::ScopedFileFaults faults(FaultAtCall(FileCall::kWrite, full_at, {.error = ENOSPC}));
      work();
    });
    interruptions_ += outcome.exit_code != 0 ? 1u : 0u;
    fs::remove("again.reeb");
    std::vector<std::string> rest = words;
    rest.emplace_back("--resume");
    run(rest);
  }

  void use(const Complex& complex, std::uint64_t seed) {
    Random random(seed);
    write_file("mesh.obj", obj_of(complex));
    write_file("values.f64", values_of(complex));
    const std::string chunk = std::to_string(random.between(1, 40)), threads = std::to_string(random.between(1, 2));
    const auto compute = [&](const std::string& mesh, const std::string& output) {
      return std::vector<std::string>{"compute", mesh,  "-f",        "file:values.f64", "-o",     output,
                                      "--chunk", chunk, "--threads", threads,           "--quiet"};
    };
    run(compute("mesh.obj", "mesh.reeb"));
    run({"compute", "mesh.obj", "-f", "x", "-f", "z", "-o", "two", "--denoise", "1%", "--quiet"});
    ::setenv("REEB_CHECKPOINT_SECONDS", "0", 1);
    resume(compute("mesh.obj", "again.reeb"), random.between(1, 60));
    ::unsetenv("REEB_CHECKPOINT_SECONDS");
    EXPECT_TRUE(read_file("again.reeb") == read_file("mesh.reeb")) << "a resumed run gives other bytes";
    run({"verify", "mesh.reeb", "--mesh", "mesh.obj"});
    run({"verify", "two-x.reeb", "--mesh", "mesh.obj"});
    run({"info", "mesh.obj", "--json"});
    run({"extract", "mesh.reeb", "--nodes", "1000", "-o", "mesh.json"});
    run({"extract", "two-z.reeb", "-o", "two.vtp"});
    run({"pairs", "mesh.reeb", "-o", "mesh.csv"});
    run({"convert", "mesh.obj", "mesh.ply", "--finalize"});
    run({"convert", "mesh.obj", "hilbert.off", "--order", "hilbert"});
    // What fails must leave nothing either.
    run({"extract", "mesh.obj", "-o", "none.rg"}, 1);
    run({"compute", "mesh.obj", "-f", "property:none", "-o", "none.reeb"}, 1);
    for (const auto& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry.path());
  }

  std::uint64_t interruptions_ = 0;

 private:
  fs::path before_ = fs::current_path();
  ooc::Scratch folder_;
};

// Memory is compared with that after a tenth of the meshes: buffers of the system's libraries grow at first.
TEST_F(Soak, MemoryAndDescriptorsStayFlat) {
  const std::uint64_t meshes = case_count(100), seed = base_seed(), first = std::max<std::uint64_t>(meshes / 10, 1);
  Held at_first;
  for (std::uint64_t i = 1; i <= meshes && !HasFailure(); ++i) {
    SCOPED_TRACE("mesh " + std::to_string(i));
    Complex complex = random_complex(seed + i);
    for (std::uint64_t again = 1; complex.vertex_count() == 0; ++again)
      complex = random_complex(seed + i + (again << 32));
    use(complex, seed + i);
    if (i != first && i != meshes / 2 && i != meshes) continue;
    const Held held = held_now();
    std::printf("after %4llu meshes: %6.1f MiB resident, %zu descriptors\n", static_cast<unsigned long long>(i),
                static_cast<double>(held.resident_bytes) / (1 << 20), held.descriptors);
    if (i == first) at_first = held;
    EXPECT_EQ(held.descriptors, at_first.descriptors);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    EXPECT_LT(held.resident_bytes, at_first.resident_bytes + (4 << 20));
#endif
  }
  EXPECT_GE(interruptions_, meshes / 50);
}

// The outputs are synced to disk, which takes most of the time of such small runs elsewhere.
const bool kScratchIsInMemory = ::access("/dev/shm", W_OK) == 0 && ::setenv("TMPDIR", "/dev/shm", 1) == 0;

}  // namespace
}  // namespace reeb::test
