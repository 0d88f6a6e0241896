// A program with a data race in each of our kinds of thread, for the thread sanitizer to find, and the same without
// races. It tests that the sanitizer finds races (tests/tsan.supp) and raises no false alarm.
//
//   planted_race none|read_ahead|worker
#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "ooc/threads/read_ahead.h"
#include "ooc/threads/worker.h"

namespace {

using reeb::ooc::read_ahead;
using reeb::ooc::Worker;

constexpr int kItems = 200;

// Waits until two threads have arrived. Relaxed: it must not give the sanitizer an order.
class Meeting {
 public:
  void wait() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    here_.fetch_add(1, std::memory_order_relaxed);
    while (here_.load(std::memory_order_relaxed) < 2 && std::chrono::steady_clock::now() < end) continue;
  }

 private:
  std::atomic<int> here_ = 0;
};

int prepared = 0;  // the race

int items_read_ahead(bool race) {
  int read = 0, sum = 0;
  Meeting meeting;
  read_ahead<int>(
      true,
      [&](int& piece) {
        // The first one is read and prepared by this thread, and the rest is then worth another one.
        if (read == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        piece = read;
        return read++ < kItems;
      },
      [&](int& piece) {
        if (piece > 0) meeting.wait();
        if (race) ++prepared;
        ++piece;
      },
      [&](int& piece) { sum += piece; });
  return sum;
}

int work_in_background(bool race) {
  int sum = 0;
  Meeting meeting;
  Worker worker;
  for (int i = 0; i < kItems; ++i) {
    worker.start([&] {
      meeting.wait();
      ++sum;
    });
    if (race) {
      meeting.wait();
      ++sum;
    }
    worker.wait();
  }
  return sum;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const std::string race = argument_count > 1 ? arguments[1] : "none";
  std::printf("%d %d\n", items_read_ahead(race == "read_ahead"), work_in_background(race == "worker"));
}
