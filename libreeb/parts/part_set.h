// Which parts of a mesh there are, of a fixed number; and from which part to which a vertex is named.
#pragma once

#include <cstdint>
#include <vector>

namespace reeb {

// No part before `first` or after `last` names the vertex, and perhaps not every part between.
struct PartSpan {
  std::uint32_t first = 0, last = 0;
  bool reaches_beyond(std::uint32_t part) const { return first != part || last != part; }
  friend bool operator==(const PartSpan&, const PartSpan&) = default;
};

class PartSet {
 public:
  explicit PartSet(std::uint32_t parts = 0) : gap_(parts) {
    for (std::uint32_t i = 0; i < parts; ++i) gap_[i] = i;
  }

  // The number of parts of the whole.
  std::uint32_t parts() const { return static_cast<std::uint32_t>(gap_.size()); }
  // The next three REQUIRE numbers below that.
  bool contains(std::uint32_t part) const { return gap_[part] != part; }
  bool contains(const PartSpan& span) const { return gap_[span.first] > span.last; }
  // O(parts).
  void add(const PartSpan& span) {
    for (std::uint32_t i = span.last + 1; i-- > span.first;) gap_[i] = i + 1 < parts() ? gap_[i + 1] : parts();
    for (std::uint32_t i = span.first; i-- > 0 && contains(i);) gap_[i] = gap_[i + 1];
  }
  // The first part that is missing; parts() if none is.
  std::uint32_t first_missing() const { return parts() == 0 ? 0 : gap_[0]; }
  // The longest runs of parts, ascending.
  std::vector<PartSpan> runs() const {
    std::vector<PartSpan> runs;
    for (std::uint32_t i = 0; i < parts(); ++i)
      if (contains(i)) {
        runs.push_back({i, gap_[i] - 1});
        i = gap_[i] - 1;
      }
    return runs;
  }

 private:
  std::vector<std::uint32_t> gap_;  // the first part from here on that is missing
};

}  // namespace reeb
