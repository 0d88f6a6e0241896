// The parts of a mesh that are in some balls, collected in one reading and taken up one group of balls after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/patches/ball_grid.h"
#include "ooc/patches/collected_surface.h"
#include "ooc/patches/vertex_set.h"
#include "ooc/tables/partition_logs.h"

namespace reeb::ooc {

struct GroupedBall {
  Ball ball;
  std::uint32_t group = 0;
  bool measured = false;  // its triangles count for mean_edge()
};

// Use: add() every batch of the mesh, finish(), then take the surface of each group. What is in the balls of several
// groups is in the surface of each.
//
// MEMORY:  while the mesh is read, 100 bytes for each ball, 2 for each vertex in one, a bit per vertex of the mesh, and
//          32 KiB for each group, and 24 for each vertex in a measured ball, from the budget; then a surface at a time.
//          The rest is in a temporary file: some 110 bytes for each vertex in the balls.
// THREADS: one at a time.
class DividedSurface {
 public:
  // `functions`: values that come with each vertex. `temp` and `budget` must outlive this.
  DividedSurface(std::span<const GroupedBall> balls, std::size_t groups, std::size_t functions, const io::TempDir& temp,
                 MemoryBudget& budget);

  // `values[k]` are those of function k at the vertices of the batch.
  // THROWS: Error{kResource} if the memory or the disk does not suffice.
  void add(const MeshBatch& batch, std::span<const std::vector<double>> values);
  void finish();

  // Of the triangles whose corners are all in measured balls; 0 if there are none. The groups do not matter.
  double mean_edge() const {
    return measured_edges_ == 0 ? 0 : measured_length_ / static_cast<double>(measured_edges_);
  }

  // THROWS: Error{kResource} if the memory does not suffice.
  CollectedSurface surface(std::uint32_t group);

 private:
  using Groups = std::vector<std::uint32_t>;
  struct Triangle {
    std::array<std::uint32_t, 3> corners;  // numbers of vertices in the balls; kNone: it is in no ball
  };

  void add_triangle(VertexId a, VertexId b, VertexId c);
  void measure(const Triangle& triangle);
  // Of a point: the number of its set of groups, kNone if it is in no ball; whether it is in a measured one.
  struct Place {
    std::uint32_t groups = BallGrid::kNone;
    bool measured = false;
  };
  Place place_of(const Point& point);

  MemoryBudget* budget_;
  std::size_t functions_;
  std::optional<BallGrid> grid_;
  std::vector<std::uint32_t> group_of_ball_;
  std::vector<std::uint8_t> ball_is_measured_;
  VertexSet set_, measured_;  // the second one by numbers of the first
  std::vector<Point> measured_positions_;
  double measured_length_ = 0;
  std::uint64_t measured_edges_ = 0;
  // Numbers by the vertex, nearly all of them small.
  class SetNumbers {
   public:
    void push_back(std::uint32_t x) {
      if (x >= kLarge) large_.emplace(low_.size(), x);
      low_.push_back(static_cast<std::uint16_t>(std::min(x, kLarge)));
    }
    std::uint32_t operator[](std::uint32_t i) const { return low_[i] < kLarge ? low_[i] : large_.at(i); }
    std::uint64_t memory_bytes() const { return 2 * low_.size() + 64 * large_.size(); }

   private:
    static constexpr std::uint32_t kLarge = 0xffff;
    std::deque<std::uint16_t> low_;  // grows without a copy
    std::map<std::size_t, std::uint32_t> large_;
  };
  SetNumbers groups_of_;      // of sets_
  std::vector<Groups> sets_;  // first, each group alone
  std::map<Groups, std::uint32_t> several_;
  Groups at_point_;
  // Of each vertex: its number, its index in the mesh, the bits of its coordinates and values.
  PartitionLogs<std::uint64_t> vertices_;
  PartitionLogs<Triangle> triangles_;
  Reservation memory_;
};

}  // namespace reeb::ooc
