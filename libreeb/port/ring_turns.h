// Port: two threads share the slots of a ring, which one of them fills and the other one uses.
#pragma once

#include <cstddef>

namespace reeb {

// Each thread goes from slot to slot. It waits only where it must: the first one when all slots are full, the second
// one when none is.
//
// THREADS: these two, once.
class RingTurns {
 public:
  static constexpr std::size_t kSlots = 4;

  RingTurns() = default;
  RingTurns(const RingTurns&) = delete;
  RingTurns& operator=(const RingTurns&) = delete;
  virtual ~RingTurns() = default;

  // For the thread that fills slots. These return false if the other one has stopped.
  // The next slot is full. Waits until the one after it is empty.
  virtual bool filled() = 0;
  // Waits until at most `most` slots are full.
  virtual bool wait_until_used(std::size_t most) = 0;
  // No more slots are filled.
  virtual void close() = 0;
  // How many slots are full, at most: the other one may use some meanwhile. What it did with those that are no longer
  // counted is visible.
  virtual std::size_t full() = 0;

  // For the thread that uses them. Waits until the next slot is full; false if none is and the ring is closed.
  virtual bool next() = 0;
  // That slot is empty now.
  virtual void used() = 0;
  // No more slots are used.
  virtual void stop() = 0;

  // From lock() to unlock(), the other thread waits in lock().
  virtual void lock() = 0;
  virtual void unlock() = 0;
};

}  // namespace reeb
