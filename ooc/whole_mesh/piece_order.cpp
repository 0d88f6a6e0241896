#include "ooc/whole_mesh/piece_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kTrianglesPerCell = 65536, kPiecesPerSmallCell = 2;  // at most, on average
constexpr unsigned kCellBits = 10;                                           // of a cell's place along an axis
constexpr std::uint32_t kMostCells = 1u << kCellBits;

// Cells of the shape of an average piece, passed to and fro: slabs across the axis with most cells, bars of a slab,
// cells of a bar.
class Cells {
 public:
  Cells(const std::vector<MeshPiece>& pieces, const std::array<double, 3>& sides) {
    // A flat piece is taken to have some thickness.
    const double least = *std::ranges::max_element(sides) / 1024;
    for (std::size_t k = 0; k < 3; ++k) unit_[k] = least > 0 && std::isfinite(least) ? std::max(sides[k], least) : 1;
    low_.fill(std::numeric_limits<float>::infinity());
    std::array<float, 3> high;
    high.fill(-std::numeric_limits<float>::infinity());
    for (const MeshPiece& piece : pieces)
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], piece.centre[k]);
        high[k] = std::max(high[k], piece.centre[k]);
      }
    for (std::size_t k = 0; k < 3 && !pieces.empty(); ++k) length_[k] = (double{high[k]} - double{low_[k]}) / unit_[k];
    std::ranges::sort(axes_, [this](std::size_t a, std::size_t b) {
      return std::tuple(-length_[a], a) < std::tuple(-length_[b], b);
    });
    set_side(std::max(length_[axes_[0]], std::numeric_limits<double>::min()));
  }

  // Makes cells smaller until there are at least that many with a piece in them.
  void divide(const std::vector<MeshPiece>& pieces, std::uint64_t cells, double step) {
    std::vector<std::uint64_t> ranks(pieces.size());
    while (length_[axes_[0]] > 0 && counts_[0] < kMostCells / 2) {
      std::ranges::transform(pieces, ranks.begin(), [this](const MeshPiece& piece) { return rank(piece); });
      std::ranges::sort(ranks);
      const auto distinct = std::unique(ranks.begin(), ranks.end()) - ranks.begin();
      if (static_cast<std::uint64_t>(distinct) >= cells) return;
      set_side(side_ * step);
    }
  }

  // Lower for a piece that is passed earlier. It has 3 * kCellBits bits.
  std::uint64_t rank(const MeshPiece& piece) const {
    std::array<std::uint64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = (double{piece.centre[axes_[k]]} - double{low_[axes_[k]]}) / unit_[axes_[k]] / side_;
      cell[k] = static_cast<std::uint64_t>(std::clamp(along, 0.0, counts_[k] - 1.0));
    }
    std::uint64_t passed = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if (passed % 2 == 1) cell[k] = counts_[k] - 1 - cell[k];
      passed = passed * counts_[k] + cell[k];
    }
    return passed;
  }

 private:
  void set_side(double side) {
    side_ = side;
    for (std::size_t k = 0; k < 3; ++k)
      counts_[k] = static_cast<std::uint32_t>(std::min(1 + length_[axes_[k]] / side, kMostCells - 1.0));
  }

  std::array<float, 3> low_;
  std::array<double, 3> unit_;  // all lengths are in these units
  std::array<double, 3> length_{};
  std::array<std::size_t, 3> axes_ = {0, 1, 2};  // the longest first
  double side_ = 1;
  std::array<std::uint32_t, 3> counts_ = {1, 1, 1};
};

}  // namespace

void order_pieces(MeshPieces& mesh) {
  std::vector<MeshPiece>& pieces = mesh.pieces;
  std::uint64_t triangles = 0;
  for (const MeshPiece& piece : pieces) triangles += piece.triangles;
  Cells large(pieces, mesh.sides);
  large.divide(pieces, std::min<std::uint64_t>(pieces.size(), triangles / kTrianglesPerCell), 0.75);
  Cells small = large;
  small.divide(pieces, pieces.size() / kPiecesPerSmallCell, 0.5);
  for (MeshPiece& piece : pieces) piece.rank = large.rank(piece) << (3 * kCellBits) | small.rank(piece);
  std::ranges::sort(
      pieces, {}, [](const MeshPiece& piece) { return std::tuple(piece.rank, piece.place.first, piece.place.second); });
}

PiecewiseMesh::PiecewiseMesh(std::unique_ptr<IndexedMesh> mesh, MeshPieces pieces)
    : mesh_(std::move(mesh)), pieces_(std::move(pieces)), counts_(mesh_->simplex_counts()) {
  for (const MeshPiece& piece : pieces_.pieces) triangle_count_ += piece.triangles;
}

void PiecewiseMesh::rewind() {
  next_ = left_ = 0;
  triangles_read_ = 0;
}

bool PiecewiseMesh::read(std::vector<VertexId>& corners, std::size_t limit) {
  corners.clear();
  while (corners.size() < 3 * limit) {
    if (left_ == 0) {
      if (next_ == pieces_.pieces.size()) break;
      const MeshPiece& piece = pieces_.pieces[next_++];
      mesh_->seek(piece.place);
      left_ = piece.triangles;
    }
    if (!mesh_->read(more_, std::min(left_, limit - corners.size() / 3))) break;
    left_ -= more_.size() / 3;
    if (corners.empty())
      corners.swap(more_);
    else
      corners.insert(corners.end(), more_.begin(), more_.end());
  }
  triangles_read_ += corners.size() / 3;
  return !corners.empty();
}

std::uint64_t PiecewiseMesh::bytes_read() const {
  if (triangle_count_ == 0) return bytes_total();
  const double part = static_cast<double>(triangles_read_) / static_cast<double>(triangle_count_);
  return static_cast<std::uint64_t>(part * static_cast<double>(bytes_total()));
}

}  // namespace reeb::ooc
