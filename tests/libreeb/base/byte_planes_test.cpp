// Byte planes against shifts.
#include "libreeb/base/byte_planes.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb {
namespace {

template <class Word>
std::vector<std::byte> shifted(const std::vector<Word>& numbers) {
  std::vector<std::byte> planes;
  for (unsigned p = 0; p < sizeof(Word); ++p)
    for (const Word number : numbers) planes.push_back(static_cast<std::byte>(number >> 8 * p));
  return planes;
}

template <class Word>
void expect_both_directions() {
  test::Random random(test::base_seed());
  for (std::size_t count = 0; count < 200; ++count) {
    std::vector<Word> numbers(count), back(count);
    for (Word& number : numbers) number = static_cast<Word>(random.next());
    std::vector<std::byte> planes(sizeof(Word) * count + 1, std::byte{7});
    split_planes(numbers, planes.data());
    EXPECT_EQ(planes.back(), std::byte{7});
    planes.pop_back();
    EXPECT_EQ(planes, shifted(numbers));
    std::array<const std::byte*, sizeof(Word)> places;
    for (std::size_t p = 0; p < places.size(); ++p) places[p] = planes.data() + p * count;
    join_planes(places, back);
    EXPECT_EQ(back, numbers);
  }
}

TEST(BytePlanes, AreTheBytesOfNumbersInBothDirections) {
  expect_both_directions<std::uint64_t>();
  expect_both_directions<std::uint32_t>();
}

TEST(BytePlanes, MayBeTheSame) {
  const std::vector<std::byte> plane(100, std::byte{0xab});
  std::array<const std::byte*, kBytePlanes> places;
  places.fill(plane.data());
  std::vector<std::uint64_t> numbers(plane.size());
  join_planes(places, numbers);
  EXPECT_EQ(numbers, std::vector<std::uint64_t>(100, 0xababababababababu));
}

}  // namespace
}  // namespace reeb
