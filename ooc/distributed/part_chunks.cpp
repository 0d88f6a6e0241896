#include "ooc/distributed/part_chunks.h"

namespace reeb::ooc {

PartChunks::PartChunks(ChunkSource& triangles, IndexedMesh& mesh, PartUses& uses, std::uint32_t part,
                       FunctionValues& functions, const ChunkPlace& start)
    : triangles_(triangles),
      mesh_(mesh),
      uses_(uses),
      part_(part),
      functions_(functions),
      lookup_(functions),
      end_(start),
      next_vertex_(uses.shares().first_vertex(part)) {
  std::vector<VertexId> ids;  // that an earlier process had
  while (next_vertex_ < start.next_vertex && uses_.find_unused(next_vertex_, start.next_vertex, 4096, ids))
    unused_ += ids.size();
}

bool PartChunks::next(WorkItem& item) { return next_triangles(item) || next_unused(item); }

bool PartChunks::next_triangles(WorkItem& item) {
  if (triangles_ended_ || !triangles_.next(item)) {
    triangles_ended_ = true;
    return false;
  }
  Chunk& chunk = item.chunk;
  ids_.assign(chunk.ids.begin(), chunk.ids.end());
  mesh_.from_original(ids_);
  uses_.find(ids_, part_, spans_);
  for (std::size_t i = 0; i < spans_.size(); ++i)
    if (spans_[i].reaches_beyond(part_)) chunk.uses[i] = kUsedEarlier | kUsedLater;
  end_ = item.end;
  return true;
}

bool PartChunks::next_unused(WorkItem& item) {
  constexpr std::size_t kVerticesAtOnce = 16384;
  item.chunk.clear();
  if (!uses_.find_unused(next_vertex_, uses_.shares().first_vertex(part_ + 1), kVerticesAtOnce, item.chunk.ids))
    return false;
  unused_ += item.chunk.ids.size();
  item.chunk.uses.assign(item.chunk.vertex_count(), kUsedHereOnly);
  lookup_.look_up(mesh_, item);
  end_.next_vertex = next_vertex_;
  end_.ranges = functions_.ranges();
  item.end = end_;
  return true;
}

}  // namespace reeb::ooc
