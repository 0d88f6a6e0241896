// work_in_order: which steps there are, in what order, by which threads, and what happens when one throws.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ooc/threads/work_in_order.h"

namespace reeb::ooc {
namespace {

struct Piece {
  int number = 0, times_prepared = 0;
};

// Takes some time, which differs from call to call.
void dawdle(unsigned seed) {
  volatile unsigned x = seed;
  for (unsigned i = (seed * 2654435761u) >> 21; i > 0; --i) x = x * 5 + i;
}

void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }

// Threads, and items in the ring.
struct Setting {
  unsigned threads;
  std::size_t items;
};

class WorkInOrder : public testing::TestWithParam<Setting> {
 protected:
  template <class Read, class Prepare, class Use>
  void work(const Read& read, const Prepare& prepare, const Use& use) {
    std::vector<Piece> pieces(GetParam().items);
    work_in_order(GetParam().threads, std::span(pieces), read, prepare, use);
  }
};
INSTANTIATE_TEST_SUITE_P(Settings, WorkInOrder,
                         testing::Values(Setting{1, 1}, Setting{1, 3}, Setting{2, 1}, Setting{2, 2}, Setting{2, 4},
                                         Setting{3, 5}, Setting{4, 3}, Setting{5, 7}),
                         [](const auto& info) {
                           return std::to_string(info.param.threads) + "Threads" + std::to_string(info.param.items) +
                                  "Items";
                         });

TEST_P(WorkInOrder, ReadsPreparesAndUsesEachItemOnceInOrder) {
  for (const int slow : {0, 1, 2, 3})  // which of the steps takes longest; 3: none
    for (const int count : {0, 1, 2, 3, 7, 500}) {
      int read = 0, used = 0;
      std::atomic<int> readers = 0, users = 0;
      work(
          [&](Piece& piece) {
            EXPECT_EQ(readers++, 0);
            if (slow == 0) dawdle(static_cast<unsigned>(read));
            piece = {read, 0};
            --readers;
            return read++ < count;
          },
          [&](Piece& piece) {
            if (slow == 1) dawdle(static_cast<unsigned>(piece.number));
            ++piece.times_prepared;
          },
          [&](const Piece& piece) {
            EXPECT_EQ(users++, 0);
            if (slow == 2) dawdle(static_cast<unsigned>(piece.number));
            EXPECT_EQ(piece.number, used++);
            EXPECT_EQ(piece.times_prepared, 1);
            --users;
          });
      EXPECT_EQ(used, count);
      EXPECT_EQ(read, count + 1);
    }
}

TEST_P(WorkInOrder, ThrowsWhatAStepThrows) {
  for (const std::string step : {"read", "prepare", "use"})
    for (const int bad : {0, 1, 2, 3, 50}) {
      int read = 0, used = 0;
      const auto fail = [&](const char* here, int number) {
        if (here == step && number == bad) throw std::runtime_error(here);
      };
      std::string what;
      try {
        work(
            [&](Piece& piece) {
              fail("read", read);
              piece = {read++, 0};
              return true;
            },
            [&](Piece& piece) { fail("prepare", piece.number); },
            [&](Piece& piece) {
              fail("use", piece.number);
              EXPECT_EQ(used++, piece.number);
            });
      } catch (const std::runtime_error& error) {
        what = error.what();
      }
      EXPECT_EQ(what, step);
      EXPECT_LE(used, bad);
    }
}

TEST_P(WorkInOrder, StartsNoThreadForOneItem) {
  std::set<std::thread::id> threads;
  const auto note = [&] { threads.insert(std::this_thread::get_id()); };
  int read = 0;
  work(
      [&](Piece& /*piece*/) {
        note();
        return read++ < 1;
      },
      [&](Piece& /*piece*/) { note(); }, [&](Piece& /*piece*/) { note(); });
  EXPECT_EQ(threads, std::set{std::this_thread::get_id()});
}

// Other programs can stop a thread for long. So what threads prefer is tried again, if need be.
constexpr int kTries = 20;

// Each step takes a while, so that the threads can do what they prefer. At the start and at the end they do not.
TEST(WorkInOrderOfTwo, ReadsInTheOtherThreadAndUsesInThisOne) {
  bool is_so = false;
  for (int i = 0; i < kTries && !is_so; ++i) {
    int read = 0, read_here = 0, used_here = 0;
    std::vector<Piece> pieces(items_for(2));
    const auto here = [this_one = std::this_thread::get_id()] { return std::this_thread::get_id() == this_one; };
    work_in_order(
        2, std::span(pieces),
        [&](Piece& /*piece*/) {
          pause();
          read_here += here();
          return read++ < 40;
        },
        [](Piece& /*piece*/) {},
        [&](Piece& /*piece*/) {
          pause();
          used_here += here();
        });
    is_so = read_here < 15 && used_here > 25;
  }
  EXPECT_TRUE(is_so);
}

// All threads prepare when that takes longest.
TEST(WorkInOrderOfThree, PreparesInAllThreads) {
  std::set<std::thread::id> all;
  for (int i = 0; i < kTries && all.size() < 3; ++i) {
    std::vector<std::thread::id> preparing(30);
    struct Numbered {
      std::size_t number = 0;
    };
    std::vector<Numbered> items(items_for(3));
    std::size_t read = 0;
    work_in_order(
        3, std::span(items),
        [&](Numbered& item) {
          item.number = read;
          return read++ < preparing.size();
        },
        [&](Numbered& item) {
          pause();
          preparing[item.number] = std::this_thread::get_id();
        },
        [](Numbered& /*item*/) {});
    all = {preparing.begin(), preparing.end()};
  }
  EXPECT_EQ(all.size(), 3u);
}

// With no room for the stack of another thread.
int work_without_room() {
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = 1;
  setrlimit(RLIMIT_AS, &limit);
  int read = 0, used = 0;
  Piece pieces[4];
  work_in_order(
      3, std::span<Piece>(pieces), [&](Piece& /*piece*/) { return read++ < 20; }, [](Piece& /*piece*/) {},
      [&](Piece& /*piece*/) { ++used; });
  return used;
}

TEST(WorkInOrderDeathTest, DoesWithoutThreadsThatCannotBeStarted) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "not here: a sanitizer needs room of its own";
#endif
  EXPECT_EXIT(std::exit(work_without_room()), testing::ExitedWithCode(20), "");
}

}  // namespace
}  // namespace reeb::ooc
