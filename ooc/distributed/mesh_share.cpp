#include "ooc/distributed/mesh_share.h"

#include "libreeb/base/error.h"

namespace reeb::ooc {

void MeshShare::rewind() {
  constexpr std::uint64_t kTrianglesAtOnce = 65536;
  at_ = begin_;
  if (by_size_) return mesh_.seek_triangle(begin_);
  if (first_) return mesh_.seek(*first_);
  mesh_.rewind();
  std::vector<VertexId> corners;
  for (std::uint64_t at = 0; at < begin_; at += corners.size() / 3)
    if (!mesh_.read(corners, static_cast<std::size_t>(std::min(kTrianglesAtOnce, begin_ - at)))) throw input_changed();
  first_ = mesh_.place();
}

bool MeshShare::read(std::vector<VertexId>& corners, std::size_t limit) {
  corners.clear();
  if (at_ == end_) return false;
  if (!mesh_.read(corners, static_cast<std::size_t>(std::min<std::uint64_t>(limit, end_ - at_)))) throw input_changed();
  at_ += corners.size() / 3;
  return true;
}

}  // namespace reeb::ooc
