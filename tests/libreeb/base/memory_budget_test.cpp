#include "libreeb/base/memory_budget.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "libreeb/base/error.h"

namespace {
bool no_memory = false;
}

// Not inlined: with sanitizers, GCC 12 would inline one of a pair only and warn that they do not match.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
  void* const memory = no_memory ? nullptr : std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace reeb {
namespace {

TEST(MemoryBudget, RefusesANewOwnerWhenTheSystemHasNoMemoryForTheEntry) {
  MemoryBudget budget(1000);
  Reservation known = budget.reserve("known", 10);
  no_memory = true;
  const Reservation unknown = budget.try_reserve("unknown", 10);
  const bool grew = known.try_resize(20);
  no_memory = false;
  EXPECT_EQ(unknown.bytes(), 0u);
  EXPECT_TRUE(grew) << "an owner that has an entry needs no other";
  EXPECT_EQ(budget.used_bytes(), 20u);
  known.release();
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_EQ(budget.peak_bytes(), 20u);
}

TEST(MemoryBudget, SizesAreTextWithAPlural) {
  EXPECT_EQ(format_bytes(0), "0 bytes");
  EXPECT_EQ(format_bytes(1), "1 byte");
  EXPECT_EQ(format_bytes(1536), "1.5 KiB");
}

TEST(MemoryBudget, NamesTheOwnersWhenItRefuses) {
  MemoryBudget budget(1000, 24);
  const Reservation held = budget.reserve("chunks", 900);
  try {
    const Reservation more = budget.reserve("live graph", 200);
    FAIL() << "granted";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kResource);
    EXPECT_EQ(e.cause(), ErrorCause::kMemory);
    EXPECT_EQ(e.message(),
              "live graph needs 200 bytes more memory, but 100 bytes of 1000 bytes is free "
              "(in use: chunks 900 bytes)");
    EXPECT_NE(e.hint().find("--memory"), std::string::npos);
  }
}

// What grows in small steps would be refused again soon after the least that helps now.
TEST(MemoryBudget, HintsAtTwiceTheLimitOrMore) {
  constexpr std::uint64_t kMiB = 1 << 20;
  const auto hint = [](std::uint64_t bytes) -> std::string {
    MemoryBudget budget(24 * kMiB, 8 * kMiB);
    const Reservation held = budget.reserve("live graph", 24 * kMiB);
    try {
      budget.reserve("live graph", bytes);
      return "granted";
    } catch (const Error& e) {
      return e.hint();
    }
  };
  EXPECT_EQ(hint(1), "allow more, for instance --memory 65M");
  EXPECT_EQ(hint(100 * kMiB), "allow more, for instance --memory 233M");
}

}  // namespace
}  // namespace reeb
