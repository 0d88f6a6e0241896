// The memory of runs with snapshots. A program of its own: what a process holds counts for the programs that it starts.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/tools/program.h"

namespace reeb::test {
namespace {

class SnapshotMemory : public ProgramTest {
 protected:
  Outcome compute(const std::string& mesh) {
    return reeb({"compute", mesh, "-o", "live.reeb", "--force", "--graph-only", "--quiet", "--memory", "16M",
                 "--snapshot-every", "20000"});
  }
  static constexpr std::uint64_t kLimit = 16 << 20;
};

TEST_F(SnapshotMemory, IsRefusedBeforeItExceedsTheLimit) {
  expect_success(reeb({"generate", "scan", "--triangles", "60k", "-o", "scan.ply"}));
  const Outcome refused = compute("scan.ply");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.error.find("hint: convert the mesh with reeb convert --finalize first"), std::string::npos)
      << refused.error;
  EXPECT_FALSE(std::filesystem::exists(in_folder("live.reeb")));
  if (!kSanitized) {
    EXPECT_LE(refused.peak_rss_bytes, kLimit);
  }
}

TEST_F(SnapshotMemory, IsWithinTheLimitForAStreamThatFinalizes) {
  expect_success(reeb({"generate", "scan", "--triangles", "60k", "-o", "scan.ply"}));
  expect_success(reeb({"convert", "scan.ply", "scan.smc", "--finalize"}));
  const Outcome done = compute("scan.smc");
  expect_success(done);
  EXPECT_TRUE(std::filesystem::exists(in_folder("live-000003.reeb")));
  if (!kSanitized) {
    EXPECT_LE(done.peak_rss_bytes, kLimit);
  }
}

}  // namespace
}  // namespace reeb::test
