#include "libreeb/port/deciding_triangles.h"

#include <algorithm>

namespace reeb {

void DecidingTriangles::reduce(MeshBatch& batch) {
  std::vector<VertexId>& triangles = batch.triangles();
  for (std::size_t k = 0; k < batch.simplices.size(); ++k) {
    std::vector<VertexId>& simplices = batch.simplices[k];
    if (k == 2 || simplices.empty()) continue;
    for (std::size_t i = 0; i < simplices.size(); i += k + 1) {
      corners_.assign(simplices.begin() + static_cast<std::ptrdiff_t>(i),
                      simplices.begin() + static_cast<std::ptrdiff_t>(i + k + 1));
      std::sort(corners_.begin(), corners_.end());
      corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
      of_simplex(corners_, [&triangles](VertexId a, VertexId b, VertexId c) {
        triangles.insert(triangles.end(), {a, b, c});
      });
    }
    simplices.clear();
  }
}

bool DecidingTriangles::is_new(const Triangle& triangle) {
  if (recent_.empty()) recent_.resize(std::size_t{1} << kRecentBits);
  const std::uint64_t mixed =
      (triangle.a.value() * 0x9e3779b97f4a7c15 ^ triangle.b.value()) * 0xbf58476d1ce4e5b9 ^ triangle.c.value();
  Triangle& place = recent_[mixed * 0x94d049bb133111eb >> (64 - kRecentBits)];
  if (place == triangle) return false;
  place = triangle;
  return true;
}

}  // namespace reeb
