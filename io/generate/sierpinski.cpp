#include "io/generate/sierpinski.h"

#include <algorithm>
#include <utility>

namespace reeb::io {
namespace {

std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return a < b ? b - a : a - b; }

// The number of the pair of corners {a, b}, and back.
unsigned edge_number(unsigned a, unsigned b) {
  if (a > b) std::swap(a, b);
  return b * (b - 1) / 2 + a;
}

std::pair<unsigned, unsigned> edge_corners(unsigned edge) {
  unsigned b = 1;
  while (b * (b + 1) / 2 <= edge) ++b;
  return {edge - b * (b - 1) / 2, b};
}

}  // namespace

SierpinskiSimplex::SierpinskiSimplex(unsigned dimension, std::uint64_t triangles, bool whole_cells)
    : dimension_(dimension),
      corners_(dimension + 1),
      edges_(corners_ * dimension / 2),
      faces_(edges_ * (corners_ - 2) / 3),
      whole_cells_(whole_cells) {
  while (distance(cells_ * corners_ * faces_, triangles) < distance(cells_ * faces_, triangles)) {
    cells_ *= corners_;
    ++levels_;
  }
  for (unsigned depth = levels_; depth-- > 0;) divided_[depth] = divided_[depth + 1] * corners_ + 1;
}

unsigned SierpinskiSimplex::dimension() const { return whole_cells_ ? dimension_ : std::max(3u, dimension_); }

ExpectedTopology SierpinskiSimplex::topology() const {
  ExpectedTopology t;
  t.vertices = corners_ + divided_[0] * edges_;
  t.triangles = cells_ * faces_;
  t.euler_characteristic = static_cast<std::int64_t>(t.vertices) - static_cast<std::int64_t>(cells_ * edges_) +
                           static_cast<std::int64_t>(t.triangles);
  // The 2-skeleton of a simplex is simply connected, so the loops are those of the graph that joins every cell to its
  // corners.
  t.first_betti = cells_ * corners_ - t.vertices - cells_ + 1;
  t.max_reeb_loops = t.first_betti;
  return t;
}

void SierpinskiSimplex::append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const {
  for (std::uint64_t v = first; v < first + count; ++v) {
    const Position at = position(v);
    for (unsigned k = 0; k < dimension(); ++k) columns[k].push_back(static_cast<double>(at[k]));
  }
}

void SierpinskiSimplex::append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const {
  const auto at = corners_of(cell);
  if (whole_cells_) {
    corners.insert(corners.end(), at.begin(), at.begin() + corners_);
    return;
  }
  for (unsigned a = 0; a < corners_; ++a)
    for (unsigned b = a + 1; b < corners_; ++b)
      for (unsigned c = b + 1; c < corners_; ++c) corners.insert(corners.end(), {at[a], at[b], at[c]});
}

void SierpinskiSimplex::append_triangle(std::uint64_t triangle, std::vector<VertexId>& corners) const {
  const auto at = corners_of(triangle / faces_);
  auto k = static_cast<unsigned>(triangle % faces_);
  for (unsigned a = 0; a < corners_; ++a)
    for (unsigned b = a + 1; b < corners_; ++b) {
      const unsigned faces_here = corners_ - b - 1;
      if (k < faces_here) {
        corners.insert(corners.end(), {at[a], at[b], at[b + 1 + k]});
        return;
      }
      k -= faces_here;
    }
}

// Corner 0 of the whole simplex is the origin, corner k is 2^levels along axis k - 1.
void SierpinskiSimplex::add_corner(Position& sum, unsigned corner, std::uint64_t length) const {
  if (corner > 0) sum[corner - 1] += length;
}

SierpinskiSimplex::Position SierpinskiSimplex::position(std::uint64_t vertex) const {
  Position at{};
  std::uint64_t length = std::uint64_t{1} << levels_;
  if (vertex < corners_) {
    add_corner(at, static_cast<unsigned>(vertex), length);
    return at;
  }
  vertex -= corners_;
  const auto [a, b] = edge_corners(static_cast<unsigned>(vertex % edges_));
  // Descends to the simplex with this number; child k is moved half the way towards corner k.
  std::uint64_t number = vertex / edges_;
  for (unsigned depth = 0; number > 0; ++depth) {
    --number;
    length /= 2;
    add_corner(at, static_cast<unsigned>(number / divided_[depth + 1]), length);
    number %= divided_[depth + 1];
  }
  add_corner(at, a, length / 2);
  add_corner(at, b, length / 2);
  return at;
}

// Corner c of a simplex, which is child k of its parent: for c = k it is corner c of the parent, else the middle of the
// edge between corners c and k of the parent.
std::array<VertexId, SierpinskiSimplex::kMaxCorners> SierpinskiSimplex::corners_of(std::uint64_t cell) const {
  std::array<VertexId, kMaxCorners> at;
  for (unsigned c = 0; c < corners_; ++c) at[c] = VertexId(c);
  std::uint64_t number = 0, cells_below = cells_;
  for (unsigned depth = 0; depth < levels_; ++depth) {
    cells_below /= corners_;
    const auto child = static_cast<unsigned>(cell / cells_below);
    cell %= cells_below;
    for (unsigned c = 0; c < corners_; ++c)
      if (c != child) at[c] = VertexId(corners_ + number * edges_ + edge_number(c, child));
    number += 1 + child * divided_[depth + 1];
  }
  return at;
}

}  // namespace reeb::io
