#include "ooc/whole_mesh/triangle_stretches.h"

#include <algorithm>
#include <numeric>

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kTrianglesAtLeast = 1 << 12, kTrianglesAtMost = 1 << 17;
// For a triangle that shares no corner, with the data that callers keep per vertex: its values, twice.
constexpr std::uint64_t kTriangleBytes = 512;

std::uint64_t stretch_of(const Workspace& space) {
  return std::clamp(space.share() / kTriangleBytes, kTrianglesAtLeast, kTrianglesAtMost);
}

}  // namespace

TriangleStretches::TriangleStretches(const char* owner, IndexedMesh& mesh, Workspace& space)
    : mesh_(mesh),
      stretch_(static_cast<std::size_t>(stretch_of(space))),
      charge_(space.budget.reserve(owner, stretch_ * kTriangleBytes)) {
  mesh_.rewind();
}

bool TriangleStretches::next() {
  first_triangle_ += corners_.size() / 3;
  if (!mesh_.read(corners_, stretch_)) return false;
  vertices_.clear();
  local_numbers_.start(vertices_, corners_.size());
  numbers_.resize(corners_.size());
  local_numbers_.number(corners_, numbers_);
  order_lookups();
  return true;
}

void TriangleStretches::order_lookups() {
  lookup_order_.resize(vertices_.size());
  std::iota(lookup_order_.begin(), lookup_order_.end(), 0u);
  const auto [low, high] = std::ranges::minmax(vertices_);
  // Vertices near each other share their few pages in any order.
  constexpr std::uint64_t kNear = 16;
  if (high.value() - low.value() < kNear * vertices_.size()) return;
  std::ranges::sort(lookup_order_, {}, [this](std::uint32_t number) { return vertices_[number]; });
}

}  // namespace reeb::ooc
