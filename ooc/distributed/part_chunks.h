// The chunks of a share of a mesh: what other shares name stays open.
#pragma once

#include <cstdint>
#include <vector>

#include "ooc/chunks/chunk_source.h"
#include "ooc/chunks/vertex_lookup.h"
#include "ooc/distributed/part_uses.h"

namespace reeb::ooc {

// The chunks of `triangles`, then the vertices that no share names and that this share takes care of.
class PartChunks : public ChunkSource {
 public:
  // All must outlive it; `mesh` has the vertices.
  PartChunks(ChunkSource& triangles, IndexedMesh& mesh, PartUses& uses, std::uint32_t part, FunctionValues& functions,
             const ChunkPlace& start);

  bool next(WorkItem& item) override;
  std::uint64_t bytes_read() const override { return triangles_.bytes_read(); }
  std::uint64_t bytes_total() const override { return triangles_.bytes_total(); }
  std::uint64_t triangles_read() const override { return triangles_.triangles_read(); }
  SimplexCounts simplices_listed() const override { return triangles_.simplices_listed(); }
  std::uint64_t vertex_count() const override { return uses_.shares().vertices; }
  std::uint64_t vertex_bound() const override { return mesh_.number_count(); }

  std::uint64_t unused_vertices() const { return unused_; }  // so far

 private:
  bool next_triangles(WorkItem& item);
  bool next_unused(WorkItem& item);

  ChunkSource& triangles_;
  IndexedMesh& mesh_;
  PartUses& uses_;
  std::uint32_t part_;
  FunctionValues& functions_;
  VertexLookup lookup_;
  ChunkPlace end_;  // of the chunk before
  std::uint64_t next_vertex_, unused_ = 0;
  bool triangles_ended_ = false;
  std::vector<VertexId> ids_;
  std::vector<PartSpan> spans_;
};

}  // namespace reeb::ooc
