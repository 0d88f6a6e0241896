// A thread in parallel to its owner.
#include "ooc/threads/worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace reeb::ooc {
namespace {

TEST(Worker, DoesTasksInOrderInOneOtherThread) {
  std::vector<int> done;
  std::vector<std::thread::id> threads;
  Worker worker;
  for (int i = 0; i < 100; ++i)
    worker.start([&, i] {
      done.push_back(i);
      threads.push_back(std::this_thread::get_id());
    });
  worker.wait();
  ASSERT_EQ(done.size(), 100u);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i);
  for (const std::thread::id id : threads) EXPECT_EQ(id, threads[0]);
  EXPECT_NE(threads[0], std::this_thread::get_id());
}

TEST(Worker, ThrowsOnceWhatATaskThrew) {
  Worker worker;
  bool ran = false;
  worker.start([] { throw std::runtime_error("full"); });
  EXPECT_THROW(worker.start([&] { ran = true; }), std::runtime_error);
  EXPECT_FALSE(ran);
  worker.start([&] { ran = true; });
  worker.wait();
  EXPECT_TRUE(ran);
}

TEST(Worker, DoesTwoThingsAtATimeAndWaitsForBoth) {
  Worker worker;
  std::thread::id first, second;
  worker.do_both([&] { first = std::this_thread::get_id(); }, [&] { second = std::this_thread::get_id(); });
  EXPECT_EQ(first, std::this_thread::get_id());
  EXPECT_NE(second, first);

  bool ended = false;
  const auto slow = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ended = true;
  };
  EXPECT_THROW(worker.do_both([] { throw std::runtime_error("here"); }, slow), std::runtime_error);
  EXPECT_TRUE(ended);
  EXPECT_THROW(worker.do_both([] {}, [] { throw std::logic_error("elsewhere"); }), std::logic_error);
}

TEST(Worker, EndsItsTaskBeforeItGoes) {
  bool ended = false;
  {
    Worker worker;
    worker.start([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

TEST(Worker, PollsWhileItWaits) {
  std::atomic<bool> may_end = false, ended = false;
  Worker worker;
  worker.start([&] {
    while (!may_end) std::this_thread::yield();
    ended = true;
  });
  const auto stop = [] { throw std::runtime_error("stop"); };
  EXPECT_THROW(worker.wait(stop), std::runtime_error);
  EXPECT_FALSE(ended) << "the task goes on";
  worker.wait([&] { may_end = true; });
  EXPECT_TRUE(ended);
  worker.start([] { throw std::runtime_error("full"); });
  EXPECT_THROW(worker.wait([] {}), std::runtime_error);
}

}  // namespace
}  // namespace reeb::ooc
