// A growing set of vertices, each numbered by the order of its index.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb::ooc {

// MEMORY: 8 bytes for every 512 vertices up to the greatest one, and 64 for each of these blocks that is not empty: at
// most 9 bits for every 8 vertices, which is far less than the mesh.
class VertexSet {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // REQUIRES: greater than all vertices so far.
  void add(VertexId vertex) {
    const auto number = static_cast<std::size_t>(vertex.value() / kBits);
    while (blocks_.size() <= number) blocks_.push_back({size_, kNone});
    Block& block = blocks_[number];
    if (block.place == kNone) {
      block.place = static_cast<std::uint32_t>(words_.size() / kWords);
      words_.resize(words_.size() + kWords, 0);
    }
    words_[kWords * block.place + vertex.value() % kBits / 64] |= std::uint64_t{1} << (vertex.value() % 64);
    ++size_;
  }

  std::uint32_t size() const { return size_; }

  // Its number, from 0; kNone if it is not in the set.
  std::uint32_t find(VertexId vertex) const {
    const std::uint64_t number = vertex.value() / kBits;
    if (number >= blocks_.size() || blocks_[number].place == kNone) return kNone;
    const std::uint64_t* const words = words_.data() + kWords * blocks_[number].place;
    const std::uint64_t word = vertex.value() % kBits / 64, bit = std::uint64_t{1} << (vertex.value() % 64);
    if ((words[word] & bit) == 0) return kNone;
    std::uint32_t before = blocks_[number].before;
    for (std::size_t w = 0; w < word; ++w) before += static_cast<std::uint32_t>(std::popcount(words[w]));
    return before + static_cast<std::uint32_t>(std::popcount(words[word] & (bit - 1)));
  }

  std::uint64_t memory_bytes() const { return words_.capacity() * 8 + blocks_.capacity() * sizeof(Block); }

 private:
  static constexpr std::size_t kBits = 512, kWords = kBits / 64;
  struct Block {
    std::uint32_t before, place;  // how many vertices are in earlier blocks; of its words, unless it is empty
  };

  std::vector<std::uint64_t> words_;
  std::vector<Block> blocks_;
  std::uint32_t size_ = 0;
};

}  // namespace reeb::ooc
