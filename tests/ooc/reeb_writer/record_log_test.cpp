// The log of arc records returns them from the last to the first, whatever the blocks.
#include "ooc/reeb_writer/record_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "io/file/fault.h"
#include "libreeb/base/byte_coding.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

struct Logged {
  ArcVersion arc;
  std::uint32_t bucket_count = 0;
  std::vector<std::byte> buckets;
};

std::vector<Logged> random_records(std::size_t count, std::size_t most_bytes, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Logged> records;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = [&] { return static_cast<std::uint32_t>(random()); };
    Logged record{{NodeId(number()), NodeId(number()), number(), number()}, 0, {}};
    // A third have none; a few are as large as several small blocks.
    if (i % 3 != 0) {
      record.bucket_count = number() >> number() % 32;
      ByteWriter(record.buckets).varint(record.bucket_count);
      const std::size_t bytes = random() % (i % 50 == 1 ? most_bytes : 40);
      for (std::size_t k = 0; k < bytes; ++k) record.buckets.push_back(static_cast<std::byte>(random()));
    }
    records.push_back(std::move(record));
  }
  return records;
}

constexpr auto kRead = RecordSource::Buckets::kRead, kOnlyCounted = RecordSource::Buckets::kOnlyCounted;

void expect_backwards(RecordLog& log, const std::vector<Logged>& records, RecordSource::Buckets read) {
  PackedRecord record;
  log.rewind(read);
  for (std::size_t i = records.size(); i-- > 0;) {
    SCOPED_TRACE(testing::Message() << "record " << i);
    ASSERT_TRUE(log.next(record));
    ASSERT_EQ(record.arc, records[i].arc);
    ASSERT_EQ(record.bucket_count, records[i].bucket_count);
    if (read == kRead)
      ASSERT_TRUE(std::ranges::equal(record.buckets, records[i].buckets));
    else
      ASSERT_TRUE(record.buckets.empty());
  }
  ASSERT_FALSE(log.next(record));
  ASSERT_FALSE(log.next(record)) << "it stays at its end";
}

// An entry has 24 bytes.
class Blocks : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Bytes, Blocks, testing::Values(1, 23, 24, 48, 100, 1000, RecordLog::kBlockBytes));

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
      for (const auto read : {kOnlyCounted, kRead}) {
        expect_backwards(log, records, read);
        PackedRecord record;
        log.rewind(read);
        for (std::size_t i = 0; i < count / 2; ++i) ASSERT_TRUE(log.next(record));
        expect_backwards(log, records, read);
      }
    }
  }
}

TEST(RecordLog, BucketsThatAreOnlyCountedAreNotRead) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  RecordLog log(temp, budget, 1000);
  const auto records = random_records(1000, 100, 3);
  for (const Logged& record : records) log.add(record.arc, record.buckets);
  const auto reads = [&](RecordSource::Buckets buckets) {
    const FaultAtCall count(io::FileCall::kRead);
    const io::ScopedFileFaults faults(count);
    expect_backwards(log, records, buckets);
    return count.count();
  };
  EXPECT_GT(reads(kOnlyCounted), 0u);
  EXPECT_EQ(reads(kRead), 2 * reads(kOnlyCounted)) << "two parts of each block";
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
  expect_backwards(log, records, kRead);
}

TEST(RecordLog, AFullDiskIsReported) {
  for (const bool background : {false, true})
    expect_failing_writes_are_reported([background](const io::TempDir& temp, MemoryBudget& budget) {
      RecordLog log(temp, budget, 500, background);
      for (const Logged& record : random_records(1000, 100, 2)) log.add(record.arc, record.buckets);
      log.rewind(kRead);
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
