#include "ooc/whole_mesh/vertex_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ooc/whole_mesh/hilbert.h"

namespace reeb::ooc {
namespace {

constexpr unsigned kSlabBits = 12;

}  // namespace

CurveBox::CurveBox(std::size_t count) : axes(count) {
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
}

void CurveBox::add(std::size_t axis, std::span<const double> values) {
  double least = low[axis], most = high[axis];
  for (const double value : values) {
    least = value < least ? value : least;
    most = value > most ? value : most;
  }
  low[axis] = least;
  high[axis] = most;
}

// One scale for all axes, so that the curve's cells are cubes. Halves cannot overflow.
VertexCurve::VertexCurve(const CurveBox& box, std::uint64_t slabs) : box_(box), slabs_(slabs) {
  const auto half = [&](std::size_t axis) { return box_.high[axis] / 2 - box_.low[axis] / 2; };
  for (std::size_t a = 0; a < box_.axes; ++a) half_size_ = std::max(half_size_, half(a));
  for (std::size_t a = 0; a < box_.axes; ++a)
    if (half(a) == half_size_) longest_ = a;
}

std::uint64_t VertexCurve::slab_count(std::uint64_t vertices) {
  const double edges = std::sqrt(static_cast<double>(vertices));
  return static_cast<std::uint64_t>(std::clamp(edges / 128, 1.0, double{1u << kSlabBits}));
}

void VertexCurve::places(std::span<const double> values, std::span<std::uint64_t> places) const {
  constexpr double kCells = (1u << kHilbertBits) - 1;
  constexpr std::size_t kCellsAtOnce = 64;
  for (std::size_t begin = 0; begin < places.size(); begin += kCellsAtOnce) {
    std::array<std::array<std::uint32_t, kCellsAtOnce>, 3> cells{};
    const std::size_t some = std::min(kCellsAtOnce, places.size() - begin);
    for (std::size_t a = 0; a < box_.axes && half_size_ > 0; ++a)
      for (std::size_t i = 0; i < some; ++i) {
        const double part = (values[a * places.size() + begin + i] / 2 - box_.low[a] / 2) / half_size_;
        // Vector instructions convert to signed numbers only.
        cells[a][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(std::clamp(part, 0.0, 1.0) * kCells));
      }
    const auto indices = hilbert_indices<kCellsAtOnce>(cells);
    for (std::size_t i = 0; i < some; ++i) {
      const std::uint64_t slab = slabs_ * cells[longest_][i] >> kHilbertBits;
      places[begin + i] = slab << (3 * kHilbertBits - kSlabBits) | indices[i] >> (slabs_ == 1 ? 0 : kSlabBits);
    }
  }
}

}  // namespace reeb::ooc
