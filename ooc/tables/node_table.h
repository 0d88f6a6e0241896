// Finds the node of a vertex: a table with linear probing, at most half full.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/base/prefetch.h"
#include "libreeb/base/sweep_key.h"

namespace reeb::ooc {

// The upper end of an arc can be any node; where values are random, it mostly is far away. A look-up touches two places
// in memory, and those of successive arcs are fetched at the same time, which a binary search would not allow.
//
// MEMORY: bytes(), 8 to 16 per node.
class NodeTable {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  // REQUIRES: `nodes` outlives this. It grows to at most `most` nodes, and changes in no other way.
  NodeTable(const std::vector<SweepKey>& nodes, std::size_t most)
      : nodes_(nodes), slots_(std::bit_ceil(2 * most + 1), kNone) {
    add_new();
  }

  // Adds the nodes that have come since the last call.
  void add_new() {
    for (; added_ < nodes_.size(); ++added_) {
      std::size_t slot = home(nodes_[added_]);
      while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = added_;
    }
  }

  static std::uint64_t bytes(std::uint64_t nodes) { return std::bit_ceil(2 * nodes + 1) * sizeof(std::uint32_t); }

  // To be called some time before find(), in this order, so that what it reads arrives in the cache meanwhile.
  void prefetch_slot(const SweepKey& key) const { prefetch(&slots_[home(key)]); }
  void prefetch_node(const SweepKey& key) const {
    if (const std::uint32_t node = slots_[home(key)]; node != kNone) prefetch(&nodes_[node]);
  }

  // The index of the key among the nodes, or kNone.
  std::uint32_t find(const SweepKey& key) const {
    for (std::size_t slot = home(key); slots_[slot] != kNone; slot = (slot + 1) & (slots_.size() - 1))
      if (nodes_[slots_[slot]] == key) return slots_[slot];
    return kNone;
  }

 private:
  std::size_t home(const SweepKey& key) const {
    return static_cast<std::size_t>(key.vertex.value() * 0x9e3779b97f4a7c15u >> 20) & (slots_.size() - 1);
  }

  const std::vector<SweepKey>& nodes_;
  std::uint32_t added_ = 0;
  std::vector<std::uint32_t> slots_;
};

// The same for look-ups of which most find no node: one bit rules out 15 of 16 such keys.
//
// MEMORY: bytes(), 2 to 4 per node more.
class SparseNodeTable {
 public:
  // REQUIRES: `nodes` outlives this, unchanged.
  explicit SparseNodeTable(const std::vector<SweepKey>& nodes)
      : table_(nodes, nodes.size()),
        words_(word_count(nodes.size())),
        shift_(64 - std::countr_zero(words_.size() * kWordBits)) {
    for (const SweepKey& node : nodes) words_[bit(node) / kWordBits] |= std::uint64_t{1} << bit(node) % kWordBits;
  }

  static std::uint64_t bytes(std::uint64_t nodes) {
    return NodeTable::bytes(nodes) + word_count(nodes) * sizeof(std::uint64_t);
  }

  std::uint32_t find(const SweepKey& key) const {
    const bool may_be = (words_[bit(key) / kWordBits] >> bit(key) % kWordBits & 1) != 0;
    return may_be ? table_.find(key) : NodeTable::kNone;
  }

 private:
  static constexpr std::size_t kWordBits = 64, kNodesAWord = 4;

  static std::size_t word_count(std::uint64_t nodes) { return std::bit_ceil(nodes / kNodesAWord + 1); }
  std::size_t bit(const SweepKey& key) const {
    return static_cast<std::size_t>(key.vertex.value() * 0xd6e8feb86659fd93u >> shift_);
  }

  NodeTable table_;
  std::vector<std::uint64_t> words_;
  int shift_;
};

}  // namespace reeb::ooc
