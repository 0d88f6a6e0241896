// A growing set of vertices, each numbered by the order of its index.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb::ooc {

// MEMORY: 9 bits for every 8 vertices up to the greatest one, which is far less than the mesh.
class VertexSet {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // REQUIRES: greater than all vertices so far.
  void add(VertexId vertex) {
    const auto word = static_cast<std::size_t>(vertex.value() / 64);
    while (words_.size() <= word) {
      if (words_.size() % kWords == 0) before_.push_back(size_);
      words_.push_back(0);
    }
    words_[word] |= std::uint64_t{1} << (vertex.value() % 64);
    ++size_;
  }

  std::uint32_t size() const { return size_; }

  // Its number, from 0; kNone if it is not in the set.
  std::uint32_t find(VertexId vertex) const {
    const std::uint64_t word = vertex.value() / 64;
    if (word >= words_.size()) return kNone;
    const std::uint64_t bit = std::uint64_t{1} << (vertex.value() % 64);
    if ((words_[word] & bit) == 0) return kNone;
    std::uint32_t number = before_[word / kWords];
    for (std::size_t w = word / kWords * kWords; w < word; ++w)
      number += static_cast<std::uint32_t>(std::popcount(words_[w]));
    return number + static_cast<std::uint32_t>(std::popcount(words_[word] & (bit - 1)));
  }

  std::uint64_t memory_bytes() const { return words_.capacity() * 8 + before_.capacity() * 4; }

 private:
  static constexpr std::size_t kWords = 8;  // per entry of before_

  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
  std::uint32_t size_ = 0;
};

}  // namespace reeb::ooc
