// The triangles that decide the Reeb graph of simplices of any dimension (docs/ARCHITECTURE.md, Simplices of any
// dimension).
//
// Of a simplex with four corners or more, the triangles through its vertex of lowest index suffice, for every function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb {

enum class CellTriangles {
  // Neighbouring cells have some in common: one that came not long ago is in the complex already, and left out.
  kDeciding,
  kAll,  // for a mesh that is to be written
};

// MEMORY: 96 KB, from the first cell on.   THREADS: one at a time.
class DecidingTriangles {
 public:
  explicit DecidingTriangles(CellTriangles choice = CellTriangles::kDeciding) : choice_(choice) {}

  // Calls add(a, b, c) for the triangles of a simplex: (a, b, b) for an edge, (a, a, a) for a point.
  // REQUIRES: corners that ascend and do not repeat, at least one.
  template <class Add>
  void of_simplex(std::span<const VertexId> corners, const Add& add) {
    const std::size_t n = corners.size(), last = n - 1;
    if (n <= 3) return add(corners[0], corners[n == 1 ? 0 : 1], corners[last]);
    const bool all = choice_ == CellTriangles::kAll;
    for (std::size_t first = 0; first < (all ? n : 1); ++first)
      for (std::size_t i = first + 1; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
          if (all || is_new({corners[first], corners[i], corners[j]})) add(corners[first], corners[i], corners[j]);
  }

  // Replaces the simplices of a batch by its triangles, as they are, and those of its other simplices after them.
  void reduce(MeshBatch& batch);

  std::size_t memory_bytes() const { return recent_.capacity() * sizeof(Triangle); }

 private:
  static constexpr unsigned kRecentBits = 12;

  struct Triangle {
    VertexId a{~std::uint64_t{0}}, b, c;
    friend bool operator==(const Triangle&, const Triangle&) = default;
  };

  bool is_new(const Triangle& triangle);

  CellTriangles choice_;
  std::vector<Triangle> recent_;  // by their hash; empty before the first cell
  std::vector<VertexId> corners_;
};

}  // namespace reeb
