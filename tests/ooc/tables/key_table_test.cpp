// The ranks are those of std::lower_bound, from any allowed starting point.
#include "ooc/tables/key_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>

#include "libreeb/base/error.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

// Ascending, with many equal values. Every vertex is even, so odd ones are missing.
std::vector<SweepKey> made_keys(std::size_t count) {
  std::mt19937_64 random(count);
  std::vector<SweepKey> keys(count);
  for (std::size_t i = 0; i < count; ++i)
    keys[i] = {static_cast<double>(random() % (1 + count / 3)), VertexId(2 * static_cast<std::uint64_t>(i))};
  std::sort(keys.begin(), keys.end());
  return keys;
}

void fill(KeyTable& table, const std::vector<SweepKey>& keys) {
  for (const SweepKey& key : keys) table.append(key);
  table.seal();
}

TEST(KeyTable, RanksAreThoseOfASearch) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  // Counts around the size of the buffer, and many times that.
  for (const std::size_t count : {1u, 2u, 100u, 4095u, 4096u, 4097u, 100'000u}) {
    SCOPED_TRACE(count);
    const std::vector<SweepKey> keys = made_keys(count);
    KeyTable table(temp);
    fill(table, keys);
    EXPECT_EQ(table.spilled_bytes(), count * sizeof(SweepKey));
    EXPECT_TRUE(scratch.empty());
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
      const std::uint64_t expected = random() % count, from = i % 2 == 0 ? random() % (expected + 1) : expected;
      const auto found = std::lower_bound(keys.begin(), keys.end(), keys[expected]);
      ASSERT_EQ(static_cast<std::uint64_t>(found - keys.begin()), expected) << "a test that could not fail";
      ASSERT_EQ(table.rank(keys[expected], from), expected) << "from " << from;
      if (i % 500 == 0) table.release_pages();
    }
  }
}

TEST(KeyTable, AKeyThatIsNotThereIsAnError) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const std::vector<SweepKey> keys = made_keys(5000);
  KeyTable table(temp);
  fill(table, keys);
  for (std::size_t i = 0; i < keys.size(); i += 7) {
    const SweepKey missing{keys[i].value, VertexId(keys[i].vertex.value() + 1)};
    EXPECT_THROW(table.rank(missing, 0), std::logic_error);
    EXPECT_THROW(table.rank(missing, i), std::logic_error);
  }
  EXPECT_THROW(table.rank({-1, VertexId(0)}, 0), std::logic_error);
  EXPECT_THROW(table.rank({1e9, VertexId(0)}, keys.size() - 1), std::logic_error);
  KeyTable empty(temp);
  empty.seal();
  EXPECT_THROW(empty.rank(keys[0], 0), std::logic_error);
}

TEST(KeyTable, AFolderThatIsNotThereIsNamed) {
  try {
    const KeyTable table{io::TempDir("/nowhere/at/all")};
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos) << error.what();
  }
}

SweepKey key_of(std::uint64_t rank) { return {static_cast<double>(rank / 3), VertexId(7 * rank)}; }

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
