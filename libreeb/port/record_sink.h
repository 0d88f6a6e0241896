// Port: where the arc records of a hierarchy go as they end (docs/SEMANTICS.md, Levels).
#pragma once

#include <cstddef>
#include <span>

#include "libreeb/graph/arc_version.h"

namespace reeb {

// Records come by `died` ascending, the arcs of the last version at the end; those that die together by
// (lo, hi, born) descending. So, from the last to the first, they are in the order of a file.
class RecordSink {
 public:
  RecordSink() = default;
  RecordSink(const RecordSink&) = delete;
  RecordSink& operator=(const RecordSink&) = delete;
  virtual ~RecordSink() = default;

  // `buckets`, packed (libreeb/graph/packed_buckets.h), are valid during the call only.
  virtual void add(const ArcVersion& record, std::span<const std::byte> buckets) = 0;
  // Vertices that the step before the next records drops.
  virtual void drop(const DroppedVertices& /*dropped*/) {}
};

}  // namespace reeb
