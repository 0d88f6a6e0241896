#include "ooc/segmentation/placed_vertices.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::ooc {

PlacedVertices::PlacedVertices(const io::TempDir& temp, MemoryBudget& budget, std::uint64_t bound, PlacedNames names)
    : names_(std::move(names)),
      bound_(bound),
      range_(std::max(kLeastRange, (bound + kMostRanges - 1) / kMostRanges)),
      charge_(budget.reserve("vertices on arcs", 0)) {
  logs_.emplace("vertices on arcs", temp, budget, static_cast<std::size_t>((bound + range_ - 1) / range_));
}

void PlacedVertices::add(const SweepKey& vertex, std::uint32_t number, std::uint32_t bit) {
  const std::uint64_t index = vertex.vertex.value();
  if (index >= bound_)
    throw Error(ErrorKind::kBadInput,
                "the mesh has a vertex " + std::to_string(index) + ", but the mesh of " + names_.graph + " has " +
                    count_of(bound_, "vertex"),
                "name the mesh that the graph was computed from")
        .at(names_.mesh);
  logs_->append(static_cast<std::size_t>(index / range_),
                {vertex.value, static_cast<std::uint32_t>(index % range_) | bit, number});
  ++size_;
}

std::span<const VertexPlace> PlacedVertices::read() {
  const std::uint64_t first = next_range_ * range_;
  if (first >= bound_) return {};
  const auto range = static_cast<std::size_t>(next_range_++);
  charge_.resize(std::min(bound_, range_) * sizeof(VertexPlace));
  places_.assign(static_cast<std::size_t>(std::min(range_, bound_ - first)), {});
  logs_->rewind(range);
  for (std::uint64_t left = logs_->count(range); left != 0; --left) {
    const Record& record = logs_->next(range);
    VertexPlace& place = places_[record.offset & ~kNodeBit];
    if (place.kind != VertexPlace::Kind::kNone)
      throw std::logic_error("vertex " + std::to_string(first + (record.offset & ~kNodeBit)) + " lies on two arcs");
    place = {record.value, record.number,
             (record.offset & kNodeBit) != 0 ? VertexPlace::Kind::kNode : VertexPlace::Kind::kArc};
  }
  return places_;
}

}  // namespace reeb::ooc
