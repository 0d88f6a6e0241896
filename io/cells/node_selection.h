// Which nodes of a mesh are its vertices: not those that are inner nodes of higher-order cells and nothing else.
//
// MEMORY: two bits per node while they are marked, then a bit and an eighth.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb::io {

class NodeSelection {
 public:
  // More nodes follow those that are known.
  void add_nodes(std::uint64_t count) {
    nodes_ += count;
    dropped_.resize((nodes_ + 63) / 64);
    corners_.resize(dropped_.size());
  }
  // REQUIRES: the node is known.
  void mark_corner(VertexId node) { corners_[node.value() / 64] |= bit(node); }
  void mark_inner(VertexId node) { dropped_[node.value() / 64] |= bit(node); }

  // After all nodes were marked.
  void finish() {
    std::uint64_t kept = 0;
    for (std::size_t i = 0; i < dropped_.size(); ++i) {
      dropped_[i] &= ~corners_[i];
      if (i % kBlockWords == 0) kept_before_.push_back(kept);
      kept += static_cast<std::uint64_t>(std::popcount(~dropped_[i]));
    }
    std::vector<std::uint64_t>().swap(corners_);
  }

  bool is_dropped(std::uint64_t node) const { return (dropped_[node / 64] >> node % 64 & 1) != 0; }
  // The index of a kept node among those that are kept. REQUIRES: finish() was called.
  std::uint64_t index_of(std::uint64_t node) const {
    const std::size_t word = node / 64, block = word / kBlockWords;
    std::uint64_t kept = kept_before_[block];
    for (std::size_t i = block * kBlockWords; i < word; ++i)
      kept += static_cast<std::uint64_t>(std::popcount(~dropped_[i]));
    const std::uint64_t below = (std::uint64_t{1} << node % 64) - 1;
    return kept + static_cast<std::uint64_t>(std::popcount(~dropped_[word] & below));
  }
  std::uint64_t kept_count() const {
    std::uint64_t dropped = 0;
    for (const std::uint64_t word : dropped_) dropped += static_cast<std::uint64_t>(std::popcount(word));
    return nodes_ - dropped;
  }
  std::uint64_t node_count() const { return nodes_; }

  std::uint64_t memory_bytes() const {
    return 8 * (dropped_.capacity() + corners_.capacity() + kept_before_.capacity());
  }

 private:
  static constexpr std::size_t kBlockWords = 8;
  static std::uint64_t bit(VertexId node) { return std::uint64_t{1} << node.value() % 64; }

  std::uint64_t nodes_ = 0;
  std::vector<std::uint64_t> dropped_, corners_, kept_before_;  // the last: for every block of words
};

}  // namespace reeb::io
