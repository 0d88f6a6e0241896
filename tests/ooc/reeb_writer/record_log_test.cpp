// The log of arc records returns them from the last to the first, whatever the blocks.
#include "ooc/reeb_writer/record_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "io/file/fault.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

struct Logged {
  ArcVersion arc;
  std::vector<std::byte> buckets;
};

std::vector<Logged> random_records(std::size_t count, std::size_t most_bytes, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Logged> records;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] { return static_cast<std::uint32_t>(random()); };
    Logged record{{NodeId(number()), NodeId(number()), number(), number()}, {}};
    // A third have none; a few are as large as several small blocks.
    const std::size_t bytes = i % 3 == 0 ? 0 : random() % (i % 50 == 1 ? most_bytes : 40);
    for (std::size_t k = 0; k < bytes; ++k) record.buckets.push_back(static_cast<std::byte>(random()));
    if (bytes != 0) record.buckets[0] = static_cast<std::byte>(random() % 128);  // the number of buckets
    records.push_back(std::move(record));
  }
  return records;
}

void expect_backwards(RecordLog& log, const std::vector<Logged>& records, RecordSource::Read what) {
  const bool reads_all = what == RecordSource::Read::kAll;
  SourceRecord record;
  log.rewind(what);
  for (std::size_t i = records.size(); i-- > 0;) {
    SCOPED_TRACE(testing::Message() << "record " << i);
    const std::vector<std::byte>& buckets = records[i].buckets;
    ASSERT_TRUE(log.next(record));
    ASSERT_EQ(record.arc, records[i].arc);
    ASSERT_EQ(record.bucket_count, buckets.empty() ? 0u : std::to_integer<std::uint32_t>(buckets[0]));
    ASSERT_TRUE(std::ranges::equal(record.buckets, reads_all ? buckets : std::vector<std::byte>()));
  }
  ASSERT_FALSE(log.next(record));
  ASSERT_FALSE(log.next(record)) << "it stays at its end";
}

class Blocks : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Bytes, Blocks, testing::Values(1, 20, 100, 1000, RecordLog::kBlockBytes));

TEST_P(Blocks, RecordsComeBackFromTheLastToTheFirstAsOftenAsAsked) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  for (const std::size_t count : {0u, 1u, 2u, 2000u}) {
    SCOPED_TRACE(testing::Message() << count << " records");
    for (const bool background : {false, true}) {
      MemoryBudget budget;
      RecordLog log(temp, budget, GetParam(), background);
      const auto records = random_records(count, 4000, count + GetParam());
      for (const Logged& record : records) log.add(record.arc, record.buckets);
      EXPECT_EQ(log.record_count(), count);
      for (const auto what : {RecordSource::Read::kCounts, RecordSource::Read::kAll}) {
        expect_backwards(log, records, what);
        SourceRecord record;
        log.rewind(what);
        for (std::size_t i = 0; i < count / 2; ++i) ASSERT_TRUE(log.next(record));
        expect_backwards(log, records, what);
      }
    }
  }
}

TEST(RecordLog, NoFileIsMadeWhileABlockIsEnough) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const io::ScopedFileFaults faults(
      [](io::FileCall call) { return io::FileFault{.error = call == io::FileCall::kWrite ? ENOSPC : 0}; });
  MemoryBudget budget;
  RecordLog log(temp, budget);
  const auto records = random_records(1000, 100, 1);
  for (const Logged& record : records) log.add(record.arc, record.buckets);
  EXPECT_EQ(log.spilled_bytes(), 0u);
  expect_backwards(log, records, RecordSource::Read::kAll);
}

TEST(RecordLog, AFullDiskIsReported) {
  for (const bool background : {false, true})
    expect_failing_writes_are_reported([background](const io::TempDir& temp, MemoryBudget& budget) {
      RecordLog log(temp, budget, 500, background);
      for (const Logged& record : random_records(1000, 100, 2)) log.add(record.arc, record.buckets);
      log.rewind(RecordSource::Read::kAll);
      EXPECT_GT(log.spilled_bytes(), 0u);
    });
}

TEST(RecordLog, ABudgetWithoutRoomIsAResourceError) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(RecordLog::memory_bytes() - 1);
  EXPECT_THROW(RecordLog(temp, budget), Error);
}

}  // namespace
}  // namespace reeb::ooc
