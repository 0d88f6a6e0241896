// Fragments in files: what reading one takes from the account; what is refused.
#include "ooc/distributed/fragment_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/distributed/glue_run.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

// A mesh in one share whose graph is an arc with many buckets of one vertex each.
PartInfo info_of_one_arc(std::uint32_t buckets) {
  PartInfo info;
  info.mesh.shares = {.triangles = 1, .vertices = 3, .parts = 1};
  info.mesh.numbers = 3;
  info.function = "z";
  info.buckets = buckets;
  info.runs = {{0, 0}};
  info.range = {0, 1};
  info.settled_nodes = 2;
  info.settled_arcs = 1;
  return info;
}

// The arc goes from 0 to 1, so its buckets are 0 to `info.buckets`, or fewer.
void write_arc(const std::string& path, const io::TempDir& temp, const PartInfo& info,
               std::span<const Bucket> buckets) {
  const SweepKey lo{0, VertexId(0)}, hi{1, VertexId(1)};
  MemoryBudget budget;
  SegmentStore store(temp, budget);
  store.add_nodes(std::vector<SettledNode>{{lo, {}}, {hi, {}}});
  const ArcKeys arc{lo, hi};
  ArcLists lists;
  lists.add(buckets);
  store.add_arcs({std::span(&arc, 1), lists.view(), info.sweep().bucket_exponent.value()});
  store.finish();
  OpenPart open;
  open.live.options = info.sweep();
  open.live.bucket_begin = {0};
  open.live.path_begin = {0};
  write_fragment(path, {}, info, open, store);
}

TEST(FragmentFile, ReservesABlockPackedAndUnpacked) {
  constexpr std::uint32_t kBuckets = 1 << 17;
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const std::string path = scratch.path() + "/arc.fragment";
  const PartInfo info = info_of_one_arc(kBuckets);
  std::vector<Bucket> buckets(kBuckets);
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    buckets[i].index = static_cast<std::int64_t>(i);
    buckets[i].count = 1;
    buckets[i].mean = {1.0 / 3, 1.0 / 7, static_cast<double>(i)};  // 24 bytes: not in single precision
  }
  write_arc(path, temp, info, buckets);
  MemoryBudget budget;
  SegmentStore store(temp, budget);
  FragmentFile file(path);
  file.copy_settled(store, true);
  EXPECT_EQ(store.bucket_count(), kBuckets);
  constexpr std::uint64_t kPacked = 26 * kBuckets;  // at least: index, count and mean
  EXPECT_GE(budget.peak_bytes(), 2 * kPacked + kBuckets * sizeof(Bucket) + kPacked) << "and once in the store";
}

TEST(FragmentFile, RefusesBucketsThatNoArcHas) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  PartInfo info = info_of_one_arc(4);
  ASSERT_GE(1.0, 2 * std::ldexp(1.0, *info.sweep().bucket_exponent)) << "the arc has two buckets or more";
  const Bucket zero{.index = 0, .count = 1}, one{.index = 1, .count = 1};
  const auto with = [&](auto Bucket::*part, auto value) {
    Bucket bucket{.index = 1, .count = 2};
    bucket.*part = value;
    return bucket;
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto is_read = [&](const std::vector<Bucket>& buckets) {
    const std::string path = scratch.path() + "/arc.fragment";
    std::filesystem::remove(path);
    write_arc(path, temp, info, buckets);
    MemoryBudget budget;
    SegmentStore store(temp, budget);
    FragmentFile file(path);
    try {
      file.copy_settled(store, true);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(error.file(), path);
      return false;
    }
    return true;
  };
  EXPECT_TRUE(is_read({zero, one}));
  EXPECT_FALSE(is_read({one, zero})) << "they do not ascend";
  EXPECT_FALSE(is_read({zero, zero}));
  EXPECT_FALSE(is_read({with(&Bucket::index, std::int64_t{-1})})) << "below the arc";
  EXPECT_FALSE(is_read({with(&Bucket::index, std::int64_t{1000})})) << "above it";
  EXPECT_FALSE(is_read({with(&Bucket::count, std::uint64_t{0})}));
  EXPECT_FALSE(is_read({with(&Bucket::mean, std::array<double, 3>{0, kNan, 0})}));
  EXPECT_FALSE(is_read({with(&Bucket::spread, -1.0F)}));
  info.range = {0, 0.5};
  EXPECT_FALSE(is_read({zero})) << "the arc ends beyond the range";
}

TEST(GlueFragments, RefusesAnEmptyList) {
  const Scratch scratch;
  try {
    glue_fragments({}, scratch.path() + "/all.reeb", false, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_NE(error.hint(), "");
  }
  EXPECT_TRUE(scratch.empty());
}

}  // namespace
}  // namespace reeb::ooc
