// read_ahead: one thread or two, by how much there is to do. What two threads do is tested in work_in_order_test.cpp.
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {
namespace {

class ReadAhead : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Background, ReadAhead, testing::Bool());

TEST_P(ReadAhead, UsesAllPiecesInOrder) {
  for (int count : {0, 1, 2, 3, 4, 5, 6, 100}) {
    int read = 0;
    std::vector<int> used;
    read_ahead<int>(
        GetParam(),
        [&](int& piece) {
          if (read == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));  // then there are two threads
          piece = read;
          return read++ < count;
        },
        [&](const int& piece) { used.push_back(piece); });
    ASSERT_EQ(used.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) EXPECT_EQ(used[static_cast<std::size_t>(i)], i);
    EXPECT_EQ(read, count + 1);
  }
}

struct Piece {
  int number = 0, times_prepared = 0;
};

// Takes some time, which differs from call to call.
void dawdle(unsigned seed) {
  volatile unsigned x = seed;
  for (unsigned i = (seed * 2654435761u) >> 21; i > 0; --i) x = x * 5 + i;
}

TEST_P(ReadAhead, PreparesEachPieceOnceBeforeItIsUsed) {
  for (const unsigned slow : {0u, 1u, 2u}) {  // which of the functions takes longest
    constexpr int kPieces = 2000;
    int read = 0, used = 0;
    read_ahead<Piece>(
        GetParam(),
        [&](Piece& piece) {
          if (read == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3));  // then there are two threads
          if (slow == 0) dawdle(static_cast<unsigned>(read));
          piece = {read, 0};
          return read++ < kPieces;
        },
        [&](Piece& piece) {
          if (slow == 1) dawdle(static_cast<unsigned>(piece.number));
          ++piece.times_prepared;
        },
        [&](const Piece& piece) {
          if (slow == 2) dawdle(static_cast<unsigned>(piece.number));
          EXPECT_EQ(piece.number, used++);
          EXPECT_EQ(piece.times_prepared, 1);
        });
    EXPECT_EQ(used, kPieces);
  }
}

TEST_P(ReadAhead, TakesAnotherThreadOnlyInTheBackground) {
  std::set<std::thread::id> threads;
  int read = 0;
  read_ahead<int>(
      GetParam(),
      [&](int& /*piece*/) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        threads.insert(std::this_thread::get_id());
        return read++ < 40;
      },
      [](const int& /*piece*/) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); });
  EXPECT_EQ(threads.size(), GetParam() ? 2u : 1u);
}

// It is the time that counts, and a busy machine can stop this thread for long. So it is tried again.
TEST(ReadAheadInBackground, DoesLittleInThisThread) {
  const std::set here{std::this_thread::get_id()};
  std::set<std::thread::id> threads;
  for (int i = 0; i < 20 && threads != here; ++i) {
    threads.clear();
    int read = 0;
    read_ahead<int>(
        true,
        [&](int& /*piece*/) {
          threads.insert(std::this_thread::get_id());
          return read++ < 1;
        },
        [](const int& /*piece*/) {});
  }
  EXPECT_EQ(threads, here);
}

TEST_P(ReadAhead, ThrowsWhatPrepareThrows) {
  for (const int bad : {0, 2, 3, 4, 5, 50}) {
    int read = 0;
    const auto prepare = [&](const int& piece) {
      if (piece == bad) throw std::runtime_error("prepare");
    };
    std::string what;
    try {
      read_ahead<int>(
          GetParam(),
          [&](int& piece) {
            if (read < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // then there are two threads
            piece = read++;
            return true;
          },
          prepare, [](const int& /*piece*/) {});
    } catch (const std::runtime_error& error) {
      what = error.what();
    }
    EXPECT_EQ(what, "prepare");
  }
}

TEST_P(ReadAhead, ThrowsWhatReadAndUseThrow) {
  for (const int bad : {0, 50}) {
    const auto fail_at_bad = [&](int piece, const char* what) {
      if (piece < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (piece == bad) throw std::runtime_error(what);
    };
    int read = 0;
    const auto number = [&](int& piece) {
      piece = read++;
      return true;
    };
    EXPECT_THROW(read_ahead<int>(GetParam(), number, [&](int piece) { fail_at_bad(piece, "use"); }),
                 std::runtime_error);
    read = 0;
    EXPECT_THROW(read_ahead<int>(
                     GetParam(),
                     [&](int& piece) {
                       fail_at_bad(read, "read");
                       return number(piece);
                     },
                     [](int /*piece*/) {}),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace reeb::ooc
