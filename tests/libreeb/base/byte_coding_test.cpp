// ByteReader on what ByteWriter wrote, also in columns, on every prefix of it, and on numbers of too many bytes.
#include "libreeb/base/byte_coding.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint64_t kMaxNumber = std::numeric_limits<std::uint64_t>::max();

Bytes bytes_of(std::initializer_list<unsigned> values) {
  Bytes bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

struct Record {
  std::uint8_t small;
  std::uint32_t medium;
  std::uint64_t large, varying, next;
  double real;
  std::array<std::uint64_t, 3> planes;

  friend bool operator==(const Record&, const Record&) = default;
};

void write(const Record& record, Bytes& bytes) {
  ByteWriter out(bytes);
  out.u8(record.small);
  out.u32(record.medium);
  out.u64(record.large);
  out.varint(record.varying);
  out.delta(record.next, record.varying);
  out.f64(record.real);
  out.text("name");
  out.planes(record.planes);
}

Record read(ByteReader& in) {
  Record record{};
  record.small = in.u8();
  record.medium = in.u32();
  record.large = in.u64();
  record.varying = in.varint();
  record.next = in.delta(record.varying);
  record.real = in.f64();
  if (in.text(4) != "name") in.fail();
  in.planes(record.planes);
  return record;
}

Record random_record(test::Random& random) {
  const auto number = [&] { return random.next() >> random.below(64); };
  return {static_cast<std::uint8_t>(random.next()),
          static_cast<std::uint32_t>(random.next()),
          random.next(),
          number(),
          number(),
          static_cast<double>(random.next()) * 0x1p-20,
          {number(), number(), number()}};
}

TEST(ByteCoding, ReadsWhatWasWritten) {
  test::Random random(test::base_seed());
  for (std::uint64_t i = 0; i < test::case_count(1000); ++i) {
    const Record record = random_record(random);
    Bytes bytes;
    write(record, bytes);
    ByteReader in(bytes);
    ASSERT_EQ(read(in), record);
    ASSERT_TRUE(in.done());
  }
}

TEST(ByteCoding, NoticesEveryPrefix) {
  test::Random random(test::base_seed());
  for (int i = 0; i < 50; ++i) {
    Bytes bytes;
    write(random_record(random), bytes);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      ByteReader in(std::span<const std::byte>(bytes).first(size));
      read(in);
      ASSERT_FALSE(in.ok()) << size << " of " << bytes.size() << " bytes";
      ASSERT_FALSE(in.done());
      // After a failure every read fails: the rest is not read.
      ASSERT_EQ(in.remaining(), 0u);
      ASSERT_EQ(in.u64(), 0u);
      ASSERT_EQ(in.varint(), 0u);
    }
  }
}

TEST(ByteCoding, ReadsVarintsUpTo64Bits) {
  for (const std::uint64_t value :
       {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128}, std::uint64_t{1} << 63, kMaxNumber - 1, kMaxNumber}) {
    Bytes bytes;
    ByteWriter(bytes).varint(value);
    ByteReader in(bytes);
    EXPECT_EQ(in.varint(), value);
    EXPECT_TRUE(in.done());
  }
}

void expect_columns(const std::vector<std::uint64_t>& numbers) {
  const auto number = [&](std::size_t i) { return numbers[i]; };
  Bytes varints = bytes_of({1, 2}), deltas = varints;
  ByteWriter(varints).varints(numbers.size(), number);
  ByteWriter(deltas).deltas(numbers.size(), number);
  ByteReader in_varints(varints), in_deltas(deltas);
  for (ByteReader* in : {&in_varints, &in_deltas}) ASSERT_EQ(in->bytes(2).size(), 2u);
  std::uint64_t before = 0;
  for (const std::uint64_t expected : numbers) {
    ASSERT_EQ(in_varints.varint(), expected);
    ASSERT_EQ(before = in_deltas.delta(before), expected);
  }
  EXPECT_TRUE(in_varints.done());
  EXPECT_TRUE(in_deltas.done());
}

TEST(ByteCoding, ColumnsOfVarintsAndDeltasAreThoseOfEachNumber) {
  test::Random random(test::base_seed());
  for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
    SCOPED_TRACE(testing::Message() << count << " numbers");
    std::vector<std::uint64_t> numbers(count, kMaxNumber);
    expect_columns(numbers);
    for (std::size_t i = 0; i < count; i += 2) numbers[i] = 0;
    expect_columns(numbers);
    for (std::uint64_t& number : numbers) number = random.next() >> random.below(64);
    expect_columns(numbers);
  }
}

TEST(ByteCoding, RefusesVarintsOfMoreThan64Bits) {
  const Bytes nine(9, std::byte{0xff});
  for (unsigned tenth = 0; tenth < 256; ++tenth) {
    Bytes bytes = nine;
    bytes.push_back(static_cast<std::byte>(tenth));
    bytes.push_back(std::byte{0});
    ByteReader in(bytes);
    const std::uint64_t value = in.varint();
    EXPECT_EQ(in.ok(), tenth <= 1) << tenth;
    EXPECT_EQ(value, tenth > 1 ? 0 : tenth == 1 ? kMaxNumber : kMaxNumber >> 1);
  }
  // A number of too many bytes is refused even if the last ones are zero.
  Bytes zeros(10, std::byte{0x80});
  zeros.push_back(std::byte{0});
  ByteReader in(zeros);
  in.varint();
  EXPECT_FALSE(in.ok());
}

TEST(ByteCoding, RefusesNumbersThatDoNotFit32Bits) {
  for (const std::uint64_t value : {std::uint64_t{0xffffffff}, std::uint64_t{0x100000000}}) {
    Bytes bytes;
    ByteWriter(bytes).varint(value);
    ByteReader in(bytes);
    EXPECT_EQ(in.varint32(), static_cast<std::uint32_t>(value));
    EXPECT_EQ(in.ok(), value >> 32 == 0);
  }
}

TEST(ByteCoding, BelievesNoCountThatTheBytesCannotHold) {
  const Bytes bytes = bytes_of({1, 2, 3, 4, 5, 6, 7});
  EXPECT_TRUE(ByteReader(bytes).may_hold(3, 2));
  EXPECT_FALSE(ByteReader(bytes).may_hold(4, 2));
  EXPECT_FALSE(ByteReader(bytes).may_hold(kMaxNumber, 8));
  EXPECT_TRUE(ByteReader({}).may_hold(0, 8));
}

TEST(ByteCoding, ZigzagsSmallMagnitudesToSmallNumbers) {
  // Differences modulo 2^64: 0, -1, 1, -2, 2.
  constexpr std::uint64_t kMinus = ~std::uint64_t{0};
  const std::array<std::uint64_t, 5> differences = {0, kMinus, 1, kMinus - 1, 2};
  for (std::uint64_t i = 0; i < differences.size(); ++i) EXPECT_EQ(zigzag(differences[i]), i);
  for (const std::uint64_t difference : {std::uint64_t{1} << 63, kMinus, (std::uint64_t{1} << 63) - 1})
    EXPECT_EQ(unzigzag(zigzag(difference)), difference);
}

}  // namespace
}  // namespace reeb
