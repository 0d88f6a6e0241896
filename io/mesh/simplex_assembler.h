// Corners in, simplices out: how faces of any length become the triangles, edges and points of a batch.
//
// A face is begun, gets its corners one by one, and is ended. Each corner adds at most one simplex. So a batch can end
// anywhere, and no face has to fit into memory (a PLY triangle strip can be a whole mesh).
#pragma once

#include <cstdint>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

enum class FaceShape {
  kPolygon,   // a fan from its first corner
  kStrip,     // each corner with its two predecessors, with alternating orientation
  kPolyline,  // each corner with its predecessor: an edge
  kPoints,    // each corner alone
};

class SimplexAssembler {
 public:
  void begin(FaceShape shape) {
    shape_ = shape;
    corners_ = 0;
  }

  void add(VertexId corner, MeshBatch& batch) {
    if (shape_ == FaceShape::kPoints) return batch.points().push_back(corner);
    ++corners_;
    if (corners_ == 1) {
      first_ = last_ = corner;
      return;
    }
    if (shape_ == FaceShape::kPolyline) {
      batch.edges().insert(batch.edges().end(), {last_, corner});
    } else if (corners_ >= 3) {
      const bool turned = shape_ == FaceShape::kStrip && corners_ % 2 == 0;
      batch.triangles().insert(batch.triangles().end(), {turned ? last_ : first_, turned ? first_ : last_, corner});
    }
    if (shape_ == FaceShape::kStrip && corners_ >= 3) first_ = last_;
    last_ = corner;
  }

  // A face with two corners is an edge, one with a single corner is a vertex, one without corners is nothing.
  void end(MeshBatch& batch) {
    if (corners_ == 1) batch.points().push_back(first_);
    if (corners_ == 2 && shape_ != FaceShape::kPolyline) batch.edges().insert(batch.edges().end(), {first_, last_});
    corners_ = 0;
  }

 private:
  FaceShape shape_ = FaceShape::kPolygon;
  std::uint64_t corners_ = 0;
  VertexId first_, last_;
};

}  // namespace reeb::io
