// Items that are read, prepared and used in order, by several threads.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <system_error>
#include <thread>
#include <vector>

namespace reeb::ooc {

// With this many items, hardly any of the threads waits for another one.
constexpr std::size_t items_for(unsigned threads) { return threads <= 1 ? 1 : threads + std::size_t{2}; }

// Calls read(item) until it returns false, prepare(item) for each item, and use(item) for each in order. At any time at
// most one thread reads and at most one uses. `items` is a ring that is filled again and again.
//
// This thread and threads - 1 others do what can be done at the moment. Where they can choose, this thread uses, the
// second one reads, and all others prepare. WHY not a pipeline of TBB: there all threads take turns at reading and
// using, and what these steps work with moves from cache to cache.
//
// THROWS: what these throw; of several threads, what was thrown first. If a thread cannot be started, the others do its
// work.
template <class Item, class Read, class Prepare, class Use>
void work_in_order(unsigned threads, std::span<Item> items, const Read& read, const Prepare& prepare, const Use& use) {
  std::mutex mutex;  // of all that follows
  std::condition_variable changed;
  // Item i is in items[i % items.size()]. Begun are those that are being prepared, and all before.
  std::uint64_t read_items = 0, begun_items = 0, used_items = 0;
  std::vector<bool> is_prepared(items.size(), false);
  bool is_reading = false, is_using = false, at_end = false;
  std::exception_ptr failure;

  // Each of these does one step if it can be done now.
  using Lock = std::unique_lock<std::mutex>;
  const auto try_read = [&](Lock& lock) {
    if (is_reading || at_end || read_items - used_items == items.size()) return false;
    is_reading = true;
    Item& item = items[read_items % items.size()];
    lock.unlock();
    const bool has_read = read(item);
    lock.lock();
    is_reading = false;
    at_end = !has_read;
    if (has_read) ++read_items;
    return true;
  };
  const auto try_prepare = [&](Lock& lock) {
    if (begun_items == read_items) return false;
    const std::size_t at = begun_items++ % items.size();
    lock.unlock();
    prepare(items[at]);
    lock.lock();
    is_prepared[at] = true;
    return true;
  };
  const auto try_use = [&](Lock& lock) {
    const std::size_t at = used_items % items.size();
    if (is_using || !is_prepared[at]) return false;
    is_using = true;
    lock.unlock();
    use(items[at]);
    lock.lock();
    is_using = is_prepared[at] = false;
    ++used_items;
    return true;
  };
  const auto work = [&](const auto&... steps) {
    Lock lock(mutex);
    try {
      while (!failure && !(at_end && used_items == read_items)) {
        if ((steps(lock) || ...))
          changed.notify_all();
        else
          changed.wait(lock);
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      if (!failure) failure = std::current_exception();
    }
    changed.notify_all();
  };
  // One item is not worth another thread.
  for (Lock lock(mutex); threads > 1 && read_items < 2 && try_read(lock);) continue;
  if (read_items < 2) threads = 1;
  {
    std::vector<std::jthread> others;
    others.reserve(threads);
    try {
      if (threads > 1) others.emplace_back([&] { work(try_read, try_prepare, try_use); });
      while (others.size() + 1 < threads) others.emplace_back([&] { work(try_prepare, try_read, try_use); });
    } catch (const std::system_error&) {  // there are too many already
    }
    work(try_use, try_prepare, try_read);
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace reeb::ooc
