// The numbers of the vertices of a mesh that leaves some out, but keeps the numbers of the others: a grid without data
// in places.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace reeb {

// Vertex i of those that are there has number number_of(i); numbers ascend.
//
// TIME: logarithmic in the number of gaps. MEMORY: 16 bytes a gap.
class VertexNumbering {
 public:
  // The next `count` vertices are numbered `first`, `first` + 1, ... REQUIRES: these are greater than all before.
  void append(std::uint64_t first, std::uint64_t count) {
    if (count == 0) return;
    if (first != end()) gaps_.push_back({count_, first});
    count_ += count;
  }

  std::uint64_t count() const { return count_; }
  bool has_gaps() const { return !gaps_.empty(); }
  // One more than the last number.
  std::uint64_t end() const { return gaps_.empty() ? count_ : gaps_.back().number + (count_ - gaps_.back().index); }
  std::size_t memory_bytes() const { return gaps_.capacity() * sizeof(Gap); }

  std::uint64_t number_of(std::uint64_t index) const {
    const auto after = std::ranges::upper_bound(gaps_, index, {}, &Gap::index);
    if (after == gaps_.begin()) return index;
    const Gap& gap = after[-1];
    return gap.number + (index - gap.index);
  }
  // How many vertices from this one on have consecutive numbers.
  std::uint64_t run_from(std::uint64_t index) const {
    const auto after = std::ranges::upper_bound(gaps_, index, {}, &Gap::index);
    return (after == gaps_.end() ? count_ : after->index) - index;
  }
  // Nothing for a number that was left out.
  std::optional<std::uint64_t> index_of(std::uint64_t number) const {
    if (number >= end()) return std::nullopt;
    const auto after = std::ranges::upper_bound(gaps_, number, {}, &Gap::number);
    const std::uint64_t next = after == gaps_.end() ? count_ : after->index;  // the first index beyond the gap after it
    const std::uint64_t index = after == gaps_.begin() ? number : after[-1].index + (number - after[-1].number);
    return index < next ? std::optional(index) : std::nullopt;
  }

 private:
  // A gap: the first vertex after it.
  struct Gap {
    std::uint64_t index, number;
  };

  std::vector<Gap> gaps_;
  std::uint64_t count_ = 0;
};

}  // namespace reeb
