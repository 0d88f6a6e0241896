// How vectors that live long and grow with the front make room.
#pragma once

#include <cstddef>
#include <vector>

namespace reeb {

// Makes room for one more element, by a quarter of the size instead of doubling: the copy during
// growth and the slack after it count against a run's memory budget.
template <class T>
void grow_by_quarter(std::vector<T>& v) {
  constexpr std::size_t kLeast = 256;
  if (v.size() == v.capacity()) v.reserve(v.size() + v.size() / 4 + kLeast);
}

}  // namespace reeb
