// Two threads at the slots of a ring: what one fills the other uses, in order; and each waits for no longer than it
// must.
#include "ooc/threads/thread_turns.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

namespace reeb::ooc {
namespace {

constexpr int kItems = 20000;

// Either thread yields at times, so that each is ahead in turns.
TEST(ThreadTurns, SlotsAreUsedInTheOrderInWhichTheyAreFilled) {
  ThreadTurns turns;
  std::array<int, RingTurns::kSlots> slots{};
  std::vector<int> seen;
  std::thread user([&] {
    for (std::size_t at = 0; turns.next(); at = (at + 1) % slots.size()) {
      if (seen.size() / 100 % 2 == 0) std::this_thread::yield();
      seen.push_back(slots[at]);
      turns.used();
    }
  });
  bool goes_on = true;
  for (int i = 0; i < kItems; ++i) {
    if (i / 300 % 2 == 0) std::this_thread::yield();
    slots[static_cast<std::size_t>(i) % slots.size()] = i;
    goes_on &= turns.filled();
  }
  turns.close();
  user.join();
  EXPECT_TRUE(goes_on);
  ASSERT_EQ(seen.size(), std::size_t{kItems});
  for (int i = 0; i < kItems; ++i) ASSERT_EQ(seen[static_cast<std::size_t>(i)], i);
}

// Even a single full slot is used at once if the other thread waits for it.
TEST(ThreadTurns, WaitsUntilWhatWasFilledIsUsed) {
  ThreadTurns turns;
  int used = 0;  // read only when all is used
  std::thread user([&] {
    while (turns.next()) {
      ++used;
      turns.used();
    }
  });
  for (int i = 1; i <= 1000; ++i) {
    ASSERT_TRUE(turns.filled());
    ASSERT_TRUE(turns.wait_until_used(0));
    ASSERT_EQ(used, i);
  }
  turns.close();
  user.join();
}

// What the other thread did with a slot is visible once full() no longer counts it. The other thread looks for a slot
// only when a whole round is announced: if it waited for slots in the middle of a round, nobody would wake it.
TEST(ThreadTurns, CountsTheFullSlots) {
  constexpr int kTogether = RingTurns::kSlots / 2;
  ThreadTurns turns;
  std::atomic<int> announced = 0;  // relaxed: it must not make `used` visible
  int used = 0;
  const auto fill = [&] {
    for (int i = 0; i < kTogether; ++i) ASSERT_TRUE(turns.filled());
    announced.fetch_add(kTogether, std::memory_order_relaxed);
  };
  fill();
  EXPECT_EQ(turns.full(), std::size_t{kTogether});
  std::thread user([&] {
    for (;; turns.used()) {
      while (announced.load(std::memory_order_relaxed) == used) std::this_thread::yield();
      if (!turns.next()) return;
      ++used;
    }
  });
  for (int filled = kTogether; filled <= 1000; filled += kTogether) {
    while (turns.full() != 0) std::this_thread::yield();
    ASSERT_EQ(used, filled);
    fill();
  }
  turns.close();
  announced.fetch_add(1, std::memory_order_relaxed);
  user.join();
}

TEST(ThreadTurns, WhoeverFillsIsToldThatTheOtherHasStopped) {
  ThreadTurns turns;
  for (std::size_t filled = 1; filled < RingTurns::kSlots; ++filled) ASSERT_TRUE(turns.filled());
  std::thread user([&] {
    ASSERT_TRUE(turns.next());
    turns.stop();
  });
  EXPECT_FALSE(turns.filled());
  EXPECT_FALSE(turns.wait_until_used(0));
  user.join();
}

// Also where there is nothing to wait for.
TEST(ThreadTurns, NothingMoreIsFilledOnceTheOtherHasStopped) {
  ThreadTurns turns;
  turns.stop();
  EXPECT_FALSE(turns.filled());
  EXPECT_FALSE(turns.wait_until_used(1));
}

TEST(ThreadTurns, OneAtATimeBetweenLockAndUnlock) {
  ThreadTurns turns;
  int count = 0;
  const auto add = [&] {
    for (int i = 0; i < kItems; ++i) {
      turns.lock();
      ++count;
      turns.unlock();
    }
  };
  std::thread other(add);
  add();
  other.join();
  EXPECT_EQ(count, 2 * kItems);
}

}  // namespace
}  // namespace reeb::ooc
