// Port: where the arc records of a hierarchy go as they end (docs/SEMANTICS.md, Levels).
#pragma once

#include <cstddef>
#include <span>

#include "libreeb/graph/arc_version.h"

namespace reeb {

// Records come by `died` ascending, the arcs of the last version at the end; those with the same `died` by
// (lo, hi, born) descending. So read backwards they are in the order of a `.reeb` file.
class RecordSink {
 public:
  RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;
  virtual ~RecordSink() = default;

  // `buckets`, packed (libreeb/graph/packed_buckets.h), are valid during the call only.
  virtual void add(const ArcVersion& record, std::span<const std::byte> buckets) = 0;
  // The vertices that a cancellation drops. Called before the records of the arcs that it ends.
  virtual void drop(const DroppedVertices& /*dropped*/) {}
};

}  // namespace reeb
