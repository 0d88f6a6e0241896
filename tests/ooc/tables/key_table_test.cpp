#include "ooc/tables/key_table.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

SweepKey key_of(std::uint64_t rank) { return {static_cast<double>(rank / 3), VertexId(7 * rank)}; }

TEST(KeyTable, FindsEveryKeyFromAnyPlaceBefore) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  for (const std::uint64_t count : {1u, 2u, 4096u, 10'000u}) {
    KeyTable table(temp);
    for (std::uint64_t i = 0; i < count; ++i) table.append(key_of(i));
    table.seal();
    EXPECT_EQ(table.spilled_bytes(), count * sizeof(SweepKey));
    for (std::uint64_t i = 0; i < count; i += 1 + i / 5)
      for (std::uint64_t from = 0; from <= i; from += 1 + from / 3) ASSERT_EQ(table.rank(key_of(i), from), i);
    table.release_pages();
    EXPECT_EQ(table.rank(key_of(count - 1), 0), count - 1) << "pages come back";
    EXPECT_THROW(table.rank({0.5, VertexId(1)}, 0), std::logic_error);
    EXPECT_THROW(table.rank(key_of(count), 0), std::logic_error);
  }
  EXPECT_TRUE(scratch.empty());
}

TEST(KeyTable, ReportsAFullDisk) {
  expect_failing_writes_are_reported([](const io::TempDir& temp, MemoryBudget&) {
    KeyTable table(temp);
    for (std::uint64_t i = 0; i < 20'000; ++i) table.append(key_of(i));
    table.seal();
  });
}

TEST(KeyTable, ReportsAMappingThatIsRefused) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  KeyTable table(temp);
  table.append(key_of(1));
  const io::ScopedFileFaults faults(FaultAtCall(io::FileCall::kMap, 1, {.error = ENOMEM}));
  EXPECT_THROW(table.seal(), Error);
}

}  // namespace
}  // namespace reeb::ooc
