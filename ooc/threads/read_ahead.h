// Reads the next items while one is used.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>

#include "ooc/threads/worker.h"

namespace reeb::ooc {

// Calls read(item) until it returns false, prepare(item) for each item, and use(item) for each in order. With
// `background`, two threads do this, unless there is little to do: another one calls `read`, this one calls `use`, and
// both call `prepare` when they would wait otherwise.
//
// WHY two threads with a task of their own, and not a pipeline of TBB: there the threads take turns at `read`, and what
// it works with moves from cache to cache. Merging sorted runs takes up to twice as much processor time then.
//
// THROWS: what these throw.   MEMORY: four items.
template <class Item, class Read, class Prepare, class Use>
void read_ahead(bool background, const Read& read, const Prepare& prepare, const Use& use) {
  // Starting a thread is worth it only for more work than this.
  constexpr auto kLittle = std::chrono::milliseconds(2);
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (Item item; !background || Clock::now() - start < kLittle;) {
    if (!read(item)) return;
    prepare(item);
    use(item);
  }
  enum class State : std::uint8_t { kEmpty, kRead, kTaken, kPrepared };
  struct Slot {
    Item item;
    State state = State::kEmpty;
  };
  std::array<Slot, 4> slots;
  std::mutex mutex;  // of the states, and of:
  bool at_end = false, has_failed = false;
  std::condition_variable changed;

  using Lock = std::unique_lock<std::mutex>;
  // Calls function(item), which returns the state of the slot afterwards.
  const auto work = [&](Lock& lock, Slot& slot, const auto& function) {
    lock.unlock();
    const State after = function(slot.item);
    lock.lock();
    slot.state = after;
    changed.notify_one();
  };
  const auto prepare_any = [&](Lock& lock) {
    const auto slot = std::ranges::find(slots, State::kRead, &Slot::state);
    if (slot == slots.end()) return false;
    slot->state = State::kTaken;
    work(lock, *slot, [&](Item& item) {
      prepare(item);
      return State::kPrepared;
    });
    return true;
  };
  const auto read_all = [&](Lock& lock) {
    for (std::size_t at = 0; !has_failed;) {
      Slot& slot = slots[at];
      if (!at_end && slot.state == State::kEmpty) {
        work(lock, slot, [&](Item& item) { return read(item) ? State::kRead : State::kEmpty; });
        at_end = slot.state == State::kEmpty;
        at = (at + 1) % slots.size();
      } else if (!prepare_any(lock)) {
        if (at_end) return;
        changed.wait(lock);
      }
    }
  };
  const auto use_all = [&](Lock& lock) {
    for (std::size_t at = 0; !has_failed;) {
      Slot& slot = slots[at];
      if (slot.state == State::kPrepared) {
        work(lock, slot, [&](Item& item) {
          use(item);
          return State::kEmpty;
        });
        at = (at + 1) % slots.size();
      } else if (!prepare_any(lock)) {
        if (at_end && slot.state == State::kEmpty) return;
        changed.wait(lock);
      }
    }
  };
  const auto run = [&](const auto& loop) {
    Lock lock(mutex);
    try {
      loop(lock);
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      has_failed = true;  // the other thread must not wait for this one
      changed.notify_one();
      throw;
    }
  };
  Worker().do_both([&] { run(use_all); }, [&] { run(read_all); });
}

// The same without preparing.
template <class Item, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  read_ahead<Item>(
      background, read, [](Item&) {}, use);
}

}  // namespace reeb::ooc
