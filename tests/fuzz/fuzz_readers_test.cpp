// Every reader on mutated files, for a second each, or REEB_FUZZ_SECONDS. REEB_FUZZ_INPUT runs one saved file instead
// (see README.md). Best under sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/crash_report.h"
#include "tests/fuzz/mutator.h"
#include "tests/support/files.h"
#include "tests/support/run_limits.h"
#include "tests/support/seed.h"

// Limits allocations, so that a reader that reserves what a header announces fails here.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "max_allocation_size_mb=256:hard_rss_limit_mb=2048"; }

namespace reeb::test {
namespace {

class Fuzz : public testing::TestWithParam<const FuzzTarget*> {
 protected:
  bool run(const std::string& bytes) {
    watch_input(&bytes, std::string(GetParam()->name));
    const bool good = GetParam()->run(bytes);
    watch_input(nullptr, std::string(GetParam()->name));
    return good;
  }
};

TEST_P(Fuzz, ChangedFilesAreReadOrRefused) {
  if (const char* kept = std::getenv("REEB_FUZZ_INPUT")) {
    run(read_file(kept));
    return;
  }
  const auto time = std::chrono::seconds(number_in_environment("REEB_FUZZ_SECONDS").value_or(1));
  std::size_t sound = 0, good = 0, cases = 0;
  const auto samples = GetParam()->corpus();
  ASSERT_FALSE(samples.empty());
  for (const std::string& bytes : samples) sound += run(bytes) ? 1u : 0u;
  EXPECT_GT(sound, 0u) << "no sample is a good file";
  Mutator mutator(*GetParam(), base_seed());
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
    good += run(mutator.next()) ? 1u : 0u;
    ++cases;
  }
  EXPECT_GT(cases, 0u);
  std::printf("%zu samples, %zu of them good; %zu changed files, %zu of them good\n", samples.size(), sound, cases,
              good);
}

// Two vertices and the beginning of a third in one byte order, a corner out of range in the other. Only the size of the
// file tells that the second announces more faces than there can be.
TEST(FuzzFindings, AByteOrderThatOnlyTheSizeDecides) {
  constexpr unsigned char kBytes[] = {0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    0,    1,
                                      0,    0,    0,    0,    0,    1,    0xbd, 0x1b, 0xcf, 0xbf, 0,    0x1b,
                                      0xcf, 0xbf, 0xbd, 0x1b, 0xcf, 0xbf, 0xbd, 0x1b, 0x3f, 0x0a, 0x1b, 0xbd,
                                      0xcf, 0xcf, 0x3f, 0xbd, 0x1b, 0xcf, 0x3f, 0x57, 0xa9};
  const FuzzTarget* const target = find_fuzz_target("smb");
  ASSERT_NE(target, nullptr);
  EXPECT_TRUE(target->run(std::string(std::begin(kBytes), std::end(kBytes))));
}

// A header line that lacks `comment`, and surplus values in each vertex, one of which is not finite. The file and the
// pipe are read in batches of different sizes and must agree.
TEST(FuzzFindings, APlyWithSurplusValuesIsTheSameFromAFileAndAPipe) {
  const std::string bytes =
      "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 3\nproperty double x\npuality\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 7\n1 nan 8\n0 1 9\n3 0 1 2\n1 2\n";
  const FuzzTarget* const target = find_fuzz_target("ply-ascii");
  ASSERT_NE(target, nullptr);
  EXPECT_TRUE(target->run(bytes)) << "surplus values are ignored, whatever they are";
}

// The byte after the last one was read.
TEST(FuzzFindings, AFileOfNothingOrOfAByteOrderMark) {
  const FuzzTarget* const target = find_fuzz_target("any-mesh");
  ASSERT_NE(target, nullptr);
  for (const char* bytes : {"", "\xEF\xBB\xBF"}) EXPECT_FALSE(target->run(bytes));
}

std::vector<const FuzzTarget*> pointers() {
  std::vector<const FuzzTarget*> all;
  for (const FuzzTarget& target : fuzz_targets()) all.push_back(&target);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Readers, Fuzz, testing::ValuesIn(pointers()), [](const auto& instance) {
  std::string name(instance.param->name);
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace reeb::test
