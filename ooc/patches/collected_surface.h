// A part of a mesh in memory, and patches cut out of it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/defects/surface_patch.h"
#include "ooc/patches/ball_grid.h"

namespace reeb::ooc {

struct SurfaceContent {
  std::vector<VertexId> vertices;  // ascending
  std::vector<Point> positions;
  std::vector<std::vector<double>> values;              // by function
  std::vector<std::uint8_t> whole;                      // all triangles of the mesh at this vertex are here
  std::vector<std::array<std::uint32_t, 3>> triangles;  // with three different corners; perhaps repeated
  Reservation memory;                                   // memory_bytes() of it all
};

// THREADS: any number may read one at the same time.
class CollectedSurface {
 public:
  explicit CollectedSurface(SurfaceContent content);

  static std::uint64_t memory_bytes(std::size_t vertices, std::size_t triangles, std::size_t functions) {
    return vertices * (8 + 24 + 1 + 8 * functions + 8) + triangles * (12 + 12);
  }

  struct Patch {
    SurfacePatch surface;
    std::vector<std::vector<double>> values;  // by function
    bool limited = false;                     // it has as many vertices as it may
  };

  // What is connected with the seeds by triangles whose corners are all in the balls, up to a number of vertices. It
  // does not depend on what else is here. Seeds that are not here are ignored. `chosen` is told the number of vertices
  // before they are copied; it may throw.
  Patch cut(std::span<const VertexId> seeds, std::span<const Ball> balls, std::size_t most_vertices,
            const std::function<void(std::size_t)>& chosen = {}) const;

 private:
  struct Chosen;
  Chosen choose(std::span<const VertexId> seeds, std::span<const Ball> balls, std::size_t most_vertices) const;
  Patch copy(const Chosen& chosen) const;

  std::span<const std::uint32_t> triangles_at(std::uint32_t v) const {
    return std::span(at_).subspan(first_[v], first_[v + 1] - first_[v]);
  }

  SurfaceContent content_;
  std::vector<std::uint32_t> first_, at_;  // triangles at each vertex
};

}  // namespace reeb::ooc
