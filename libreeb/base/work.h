// Work that tells how far it is, and work for two threads.
#pragma once

#include <functional>

namespace reeb {

// For a part of the work of `poll`, which goes from `from` to `to`. `poll` must outlive the result.
inline std::function<void(double)> part_of(const std::function<void(double)>& poll, double from, double to) {
  if (!poll) return {};
  return [&poll, from, to](double done) { poll(from + done * (to - from)); };
}

// Calls both functions and returns when both have returned: the first in this thread, the second in another one. It
// throws what they throw. Empty if there is no other thread.
using DoBoth = std::function<void(const std::function<void()>& here, const std::function<void()>& elsewhere)>;

// In two threads if there are two, else one after the other.
inline void do_both(const DoBoth& both, const std::function<void()>& here, const std::function<void()>& elsewhere) {
  if (both) return both(here, elsewhere);
  here();
  elsewhere();
}

}  // namespace reeb
