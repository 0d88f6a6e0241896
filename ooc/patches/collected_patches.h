// The parts of a mesh in some balls, collected in one reading with the places of their triangles, to be edited.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/repair/editable_patch.h"
#include "ooc/patches/ball_grid.h"
#include "ooc/patches/vertex_set.h"
#include "ooc/tables/partition_logs.h"

namespace reeb::ooc {

// Some patches in memory. THREADS: any number may call const members at the same time.
class PatchGroup {
 public:
  // Its vertices ascend. `number`: among those of the group.
  EditablePatch patch(std::size_t number) const;

 private:
  friend class CollectedPatches;

  struct Vertex {
    VertexId id;
    Point position;
    bool whole = true, used_elsewhere = false;
  };
  struct Triangle {
    std::array<std::uint32_t, 3> corners;
    std::uint64_t id;
  };
  struct Line {
    std::array<std::uint32_t, 2> ends;
    std::uint64_t id;  // as EditablePatch::Line
  };
  // Those of patch p are at the places order[first[p]], ..., order[first[p + 1] - 1].
  struct ByPatch {
    std::vector<std::uint32_t> first, order;
  };

  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<Line> lines_;
  ByPatch vertices_of_, triangles_of_, lines_of_;
  Reservation memory_;
};

// Use: add() every batch of the mesh, finish(), then take the groups of patches. A patch is everything in its balls,
// connected or not.
//
// MEMORY:  while the mesh is read, 100 bytes for each ball, 2 for each vertex in one, a bit per vertex of the mesh, and
//          32 KiB for each group, from the budget; then, for a group, about 150 for each vertex in its balls. The rest
//          is in a temporary file: some 110 bytes for each vertex in the balls.
// THREADS: one at a time.
class CollectedPatches {
 public:
  // Groups have 16-bit numbers.
  static constexpr std::size_t kMostGroups = 0xffff;

  // `patch_of[i]` is the patch of ball i. Those of group g begin with first_of_group[g], and the last entry is the
  // number of all patches. REQUIRES: balls of different patches do not meet; at most kMostGroups groups.
  CollectedPatches(std::span<const Ball> balls, std::span<const std::uint32_t> patch_of,
                   std::vector<std::uint32_t> first_of_group, const io::TempDir& temp, MemoryBudget& budget);

  // THROWS: Error{kResource} if the memory or the disk does not suffice.
  void add(const MeshBatch& batch);
  void finish();

  std::uint64_t mesh_vertices() const { return mesh_vertices_; }
  std::uint64_t mesh_triangles() const { return mesh_triangles_; }

  PatchGroup group(std::size_t number);

 private:
  struct Vertex {
    std::uint64_t id;
    Point position;
    std::uint32_t number, patch;  // the number: among all vertices in balls
  };
  struct Triangle {
    std::array<std::uint32_t, 3> corners;  // numbers; kNone: in no ball
    enum Kind : std::uint32_t { kPlain, kDegenerate, kPointOrEdge } kind;
    std::uint64_t id;
  };

  struct Filling;

  void add_use(std::span<const VertexId> corners);

  MemoryBudget* budget_;
  std::optional<BallGrid> grid_;
  std::vector<std::uint32_t> patch_of_ball_, first_of_group_;
  std::vector<std::uint16_t> group_of_patch_;
  VertexSet set_;
  std::vector<std::uint16_t> group_of_;  // by number of the vertex
  PartitionLogs<Vertex> vertices_;
  PartitionLogs<Triangle> triangles_;
  std::vector<std::size_t> others_;  // by group: those of triangles_ that are not plain
  std::uint64_t mesh_vertices_ = 0, mesh_triangles_ = 0;
  Reservation memory_;
};

}  // namespace reeb::ooc
