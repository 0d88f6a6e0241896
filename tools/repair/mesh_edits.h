// What is to be changed in a mesh, and where vertices go.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/graph/settled_node.h"

namespace reeb::tools {

// A vertex of the mesh by its number, or a new one.
struct VertexRef {
  std::uint64_t number = 0;
  bool is_new = false;
};

struct NewVertex {
  Point position{};
  std::array<VertexRef, 3> parents{};  // its properties are the mean of theirs; new ones are before it
};

struct MeshEdits {
  std::vector<std::uint64_t> removed;  // triangles by their places, ascending
  std::vector<std::uint64_t> dropped;  // vertices that nothing uses any more, ascending
  std::vector<NewVertex> vertices;
  std::vector<std::array<VertexRef, 3>> triangles;

  // Adds those of another part of the mesh; sort() is needed then.
  void add(const MeshEdits& other);
  void sort();
};

// The numbers of vertices after some were dropped, and back. TIME: O(1), mostly.
class Renumbering {
 public:
  // `dropped` ascends and must outlive this.
  explicit Renumbering(const std::vector<std::uint64_t>& dropped) : dropped_(dropped) {
    for (std::size_t i = 0; i < dropped.size(); ++i)
      while (before_.size() <= dropped[i] / kBlock) before_.push_back(static_cast<std::uint32_t>(i));
  }
  bool is_identity() const { return dropped_.empty(); }
  // REQUIRES: it was not dropped.
  std::uint64_t after(std::uint64_t vertex) const { return vertex - below(vertex); }
  std::uint64_t before(std::uint64_t vertex) const {
    // As many are below the vertex as have, each less those below itself, at most the new number.
    std::size_t low = 0, high = dropped_.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (dropped_[middle] - middle <= vertex)
        low = middle + 1;
      else
        high = middle;
    }
    return vertex + low;
  }

 private:
  static constexpr std::uint64_t kBlock = 1024;

  std::uint64_t below(std::uint64_t vertex) const {
    const std::uint64_t block = vertex / kBlock;
    if (block >= before_.size()) return dropped_.size();
    const auto first = dropped_.begin() + before_[block];
    const auto end = block + 1 < before_.size() ? dropped_.begin() + before_[block + 1] : dropped_.end();
    return static_cast<std::uint64_t>(std::lower_bound(first, end, vertex) - dropped_.begin());
  }

  const std::vector<std::uint64_t>& dropped_;
  std::vector<std::uint32_t> before_;  // how many were dropped before each block
};

}  // namespace reeb::tools
