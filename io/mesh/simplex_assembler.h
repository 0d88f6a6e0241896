// Corners in, triangles out: how faces of any length become the triangles of a batch.
//
// A face is begun, gets its corners one by one, and is ended. Each corner adds at most one triangle. So a batch can end
// anywhere, and no face has to fit into memory (a PLY triangle strip can be a whole mesh).
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/base/ids.h"

namespace reeb::io {

enum class FaceShape {
  kPolygon,   // a fan from its first corner
  kStrip,     // each corner with its two predecessors, with alternating orientation
  kPolyline,  // each corner with its predecessor
};

class SimplexAssembler {
 public:
  void begin(FaceShape shape) {
    shape_ = shape;
    corners_ = 0;
  }

  void add(VertexId corner, std::vector<VertexId>& triangles) {
    ++corners_;
    if (corners_ == 1) {
      first_ = last_ = corner;
      return;
    }
    if (shape_ == FaceShape::kPolyline) {
      triangles.insert(triangles.end(), {last_, corner, corner});
    } else if (corners_ >= 3) {
      const bool turned = shape_ == FaceShape::kStrip && corners_ % 2 == 0;
      triangles.insert(triangles.end(), {turned ? last_ : first_, turned ? first_ : last_, corner});
    }
    if (shape_ == FaceShape::kStrip && corners_ >= 3) first_ = last_;
    last_ = corner;
  }

  // A face with two corners is an edge, one with a single corner is a vertex, one without corners is nothing.
  void end(std::vector<VertexId>& triangles) {
    if (corners_ == 1) triangles.insert(triangles.end(), {first_, first_, first_});
    if (corners_ == 2 && shape_ != FaceShape::kPolyline) triangles.insert(triangles.end(), {first_, last_, last_});
    corners_ = 0;
  }

 private:
  FaceShape shape_ = FaceShape::kPolygon;
  std::uint64_t corners_ = 0;
  VertexId first_, last_;
};

}  // namespace reeb::io
