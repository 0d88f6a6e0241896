// Shares never add up to more than the limit, more memory never gives less, and the smallest budgets work.
#include "ooc/run/memory_plan.h"

#include <gtest/gtest.h>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kMiB = 1 << 20;
constexpr std::uint64_t kSmallestLimit = 16 * kMiB;

// Limits from the smallest to 64 GiB, with odd ones between.
std::vector<std::uint64_t> limits() {
  std::vector<std::uint64_t> all;
  for (std::uint64_t limit = kSmallestLimit; limit <= 64 * 1024 * kMiB; limit += limit / 5 + 1) all.push_back(limit);
  return all;
}

std::vector<MemoryRequest> requests() {
  std::vector<MemoryRequest> all;
  for (const unsigned threads : {1u, 2u, 8u})
    for (const std::size_t functions : {1u, 3u})
      for (const bool in_place : {false, true})
        for (const bool denoises : {false, true})
          all.push_back({.threads = threads, .functions = functions, .in_place = in_place, .denoises = denoises});
  return all;
}

MemoryPlan plan(MemoryRequest request, std::uint64_t limit) {
  request.limit_bytes = limit;
  return plan_memory(request);
}

TEST(MemoryPlan, SharesAddUpToAtMostTheLimit) {
  for (const MemoryRequest& request : requests())
    for (const std::uint64_t limit : limits()) {
      SCOPED_TRACE(testing::Message() << limit << " bytes, " << request.functions << " functions");
      const MemoryPlan p = plan(request, limit);
      EXPECT_EQ(p.budget_bytes + p.set_aside_bytes, limit);
      EXPECT_LE((request.in_place ? 1 : 2) * p.table_bytes + request.functions * p.segment_bytes, p.budget_bytes / 5);
      EXPECT_LE(request.functions * p.most_segment_bytes, p.budget_bytes / 5);
      EXPECT_GE(p.threads, 1u);
      EXPECT_LE(p.threads, request.threads);
    }
}

// A triangle has at most three vertices of its own, usually half a vertex.
TEST(MemoryPlan, LimitsOfVerticesActOnlyWhereMemoryIsTight) {
  for (const MemoryRequest& request : requests())
    for (const std::uint64_t limit : limits()) {
      SCOPED_TRACE(testing::Message() << limit << " bytes, " << request.functions << " functions");
      MemoryPlan p = plan(request, limit);
      for (const bool front_is_known : {false, true}) {
        if (front_is_known) p.share_out({});
        const std::size_t whole = p.chunk.first + p.chunk.first / 4;
        EXPECT_GE(p.chunk.first_vertices, p.chunk.first);
        EXPECT_GE(p.chunk.most_vertices, p.chunk.most);
        if (limit >= 2048 * kMiB) {
          EXPECT_GE(p.chunk.first_vertices, 3 * whole);
          EXPECT_GE(p.chunk.most_vertices, 3 * p.chunk.most);
        } else if (limit >= 24 * kMiB && limit <= 48 * kMiB) {
          EXPECT_LT(p.chunk.first_vertices, 3 * p.chunk.first);
          EXPECT_LT(p.chunk.most_vertices, 3 * p.chunk.most);
        }
      }
    }
}

TEST(MemoryPlan, MoreMemoryNeverGivesLess) {
  for (const MemoryRequest& request : requests()) {
    MemoryPlan before = plan(request, kSmallestLimit);
    for (const std::uint64_t limit : limits()) {
      SCOPED_TRACE(testing::Message() << limit << " bytes, " << request.functions << " functions");
      const MemoryPlan p = plan(request, limit);
      EXPECT_GE(p.budget_bytes, before.budget_bytes);
      EXPECT_GE(p.table_bytes, before.table_bytes);
      EXPECT_GE(p.segment_bytes, before.segment_bytes);
      EXPECT_GE(p.most_live_vertices(), before.most_live_vertices());
      EXPECT_GE(p.threads, before.threads);
      before = p;
    }
  }
}

// A limit that is reported as needed is enough, and the largest front that is reported to fit does fit.
TEST(MemoryPlan, WhatIsSaidToBeNeededIsEnough) {
  for (const MemoryRequest& request : requests())
    for (const std::uint64_t live : {1'000u, 100'000u, 10'000'000u}) {
      const FrontNeeds needs{.vertices = 20 * live, .live_vertices = live, .function_bytes = 1000};
      const std::uint64_t needed = plan(request, 64 * 1024 * kMiB).needed_bytes(needs);
      SCOPED_TRACE(testing::Message() << live << " live vertices need " << needed << " bytes");
      EXPECT_TRUE(plan(request, needed + needed / 50 + kSmallestLimit).fits(needs));
      if (needed > 2 * kSmallestLimit) {
        EXPECT_FALSE(plan(request, needed / 2).fits(needs));
      }
    }
  for (const MemoryRequest& request : requests())
    for (const std::uint64_t limit : limits()) {
      const MemoryPlan p = plan(request, limit);
      const std::uint64_t most = p.most_live_vertices();
      EXPECT_TRUE(p.fits({.live_vertices = most})) << limit;
      EXPECT_FALSE(p.fits({.live_vertices = most + 2})) << limit;
      EXPECT_FALSE(p.exceeds({.live_vertices = most})) << limit;
    }
}

TEST(MemoryPlan, ChunksGetWhatTheLiveGraphLeaves) {
  for (const MemoryRequest& request : requests())
    for (const std::uint64_t limit : limits()) {
      MemoryPlan narrow = plan(request, limit), wide = narrow;
      narrow.share_out({.vertices = 1000, .live_vertices = 10});
      wide.share_out({.vertices = 100'000'000, .live_vertices = narrow.most_live_vertices()});
      EXPECT_LE(wide.chunk.first, narrow.chunk.first) << limit;
      for (const MemoryPlan& p : {narrow, wide}) {
        EXPECT_GE(p.chunk.first, 512u) << limit;
        EXPECT_LE(p.chunk.first, p.chunk.most) << limit;
        EXPECT_LE(p.chunk.patch, p.chunk.first) << limit;
      }
    }
}

TEST(MemoryPlan, AUsersChunksAreKept) {
  MemoryPlan p = plan({.chunk_triangles = 7, .stretch_triangles = 140}, kSmallestLimit);
  p.share_out({.vertices = 1'000'000, .live_vertices = 1'000'000});
  EXPECT_EQ(p.chunk.first, 7u);
  EXPECT_EQ(p.chunk.patch, 7u);
  EXPECT_EQ(p.chunk.most, 140u);
}

// Corners alone take 12 bytes a triangle.
TEST(MemoryPlan, AUsersChunksAreNotLargerThanMemory) {
  for (const std::size_t triangles : {std::size_t{100'000'000}, ~std::size_t{0}}) {
    const MemoryPlan p = plan({.chunk_triangles = triangles}, kSmallestLimit);
    EXPECT_LE(p.chunk.first * 12, kSmallestLimit / 2);
    EXPECT_GE(p.chunk.first, 100'000u);
    EXPECT_EQ(p.chunk.most, p.chunk.first);
    EXPECT_EQ(p.chunk.patch, p.chunk.first);
  }
}

// Boxes of a volume are larger only where memory is free.
TEST(MemoryPlan, BoxesOfVolumes) {
  for (const std::uint64_t limit : {kSmallestLimit, 92 * kMiB, 128 * kMiB, 256 * kMiB}) {
    const MemoryPlan p = plan({}, limit);
    EXPECT_EQ(p.box_triangles(), p.chunk.first) << limit;
  }
  const MemoryPlan free = plan({}, 16384 * kMiB);
  EXPECT_EQ(free.box_triangles(), 4 * ChunkSize{}.first);
  EXPECT_EQ(plan({.chunk_triangles = 100}, 16384 * kMiB).box_triangles(), 100u);
}

TEST(MemoryPlan, LessThanTheLeastIsRefused) {
  EXPECT_NO_THROW(plan({}, kSmallestLimit));
  for (const std::uint64_t limit : {std::uint64_t{0}, kSmallestLimit - 1}) try {
      plan({}, limit);
      FAIL() << limit;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource);
      EXPECT_NE(error.hint().find("--memory"), std::string::npos);
    }
  EXPECT_GT(plan({}, MemoryBudget::kUnlimited).budget_bytes, kMiB);
  // Without a limit, it is the machine's.
  EXPECT_THROW(plan({.reader_bytes = std::uint64_t{1} << 50}, MemoryBudget::kUnlimited), Error);
}

}  // namespace
}  // namespace reeb::ooc
