#include "io/generate/ball.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb::io {
namespace {

constexpr std::uint64_t kLeastTile = 3;  // a tunnel of one cube, and one on each side

// The least number from 0 to `end` for which `is_beyond` holds; `end` if there is none.
template <class Predicate>
std::uint64_t first_beyond(std::uint64_t end, const Predicate& is_beyond) {
  std::uint64_t low = 0;
  while (low < end) {
    const std::uint64_t middle = low + (end - low) / 2;
    if (is_beyond(middle))
      end = middle;
    else
      low = middle + 1;
  }
  return low;
}

std::uint64_t tiles_in_row(std::uint64_t handles) {
  auto tiles = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(handles)));
  while (tiles * tiles < handles) ++tiles;
  return std::max<std::uint64_t>(tiles, 1);
}

PerforatedSquare::Holes holes_of_cubes(std::uint64_t size, std::uint64_t handles) {
  PerforatedSquare::Holes holes;
  holes.count = handles;
  holes.tiles = tiles_in_row(handles);
  holes.pitch = std::max<std::uint64_t>(size / holes.tiles, 1);
  holes.width = std::max<std::uint64_t>(holes.pitch / 3, 1);
  holes.lead = (holes.pitch - holes.width) / 2;
  return holes;
}

// A vertex is left out if all cubes around it are.
PerforatedSquare::Holes holes_of_vertices(std::uint64_t size, std::uint64_t handles) {
  PerforatedSquare::Holes holes = holes_of_cubes(size, handles);
  ++holes.lead;
  --holes.width;
  return holes;
}

// The side of a cube of about this many cells, large enough for the handles.
std::uint64_t size_for(std::uint64_t cells, std::uint64_t handles) {
  const double share = handles == 0 ? 1 : 9. / 8;  // a tunnel takes a ninth of its tile
  const auto side = static_cast<std::uint64_t>(std::lround(std::cbrt(share * static_cast<double>(cells))));
  return std::max<std::uint64_t>({side, handles == 0 ? 1 : kLeastTile * tiles_in_row(handles), 1});
}

// The layer with this height from -1 to 1 is so large. Its last ones are not points.
double radius_at(double height) { return std::sqrt(1 - 0.96 * height * height); }

double rounded(double across) { return std::sqrt(1 - 0.45 * across * across); }

}  // namespace

std::uint64_t PerforatedSquare::in_hole(std::uint64_t before) const {
  return std::clamp(before, holes_.lead, holes_.lead + holes_.width) - holes_.lead;
}

std::uint64_t PerforatedSquare::holes_before(std::uint64_t tile_row) const {
  return std::min(holes_.count, holes_.tiles * tile_row);
}

std::uint64_t PerforatedSquare::before_row(std::uint64_t row) const {
  const std::uint64_t tile_row = row / holes_.pitch, whole = holes_before(tile_row);
  const std::uint64_t here = holes_before(tile_row + 1) - whole;
  return size_ * row - holes_.width * (whole * holes_.width + here * in_hole(row % holes_.pitch));
}

std::uint64_t PerforatedSquare::before_in_row(GridPoint p) const {
  const std::uint64_t tile_row = p.j / holes_.pitch, in_tile = p.j % holes_.pitch, tile = p.i / holes_.pitch;
  if (in_hole(in_tile) == in_hole(in_tile + 1)) return p.i;
  const std::uint64_t here = holes_before(tile_row + 1) - holes_before(tile_row);
  return p.i - std::min(tile, here) * holes_.width - (tile < here ? in_hole(p.i % holes_.pitch) : 0);
}

GridPoint PerforatedSquare::at(std::uint64_t number) const {
  GridPoint p;
  p.j = first_beyond(size_, [&](std::uint64_t row) { return before_row(row + 1) > number; });
  const std::uint64_t in_row = number - before_row(p.j);
  p.i = first_beyond(size_, [&](std::uint64_t i) { return before_in_row({i + 1, p.j}) > in_row; });
  return p;
}

DrilledBall::DrilledBall(std::uint64_t tetrahedra, std::uint64_t handles)
    : length_(1),
      size_(size_for(tetrahedra / kTetrahedra, handles)),
      handles_(handles),
      cubes_(size_, holes_of_cubes(size_, handles)),
      vertices_(size_ + 1, holes_of_vertices(size_, handles)) {
  const std::uint64_t of_layer = kTetrahedra * cubes_.count();
  length_ = std::max<std::uint64_t>((tetrahedra + of_layer / 2) / of_layer, 1);
}

ExpectedTopology DrilledBall::topology() const {
  ExpectedTopology t;
  t.vertices = (length_ + 1) * vertices_.count();
  t.tetrahedra = cell_count();
  t.first_betti = t.max_reeb_loops = handles_;
  t.euler_characteristic = 1 - static_cast<std::int64_t>(handles_);
  return t;
}

void DrilledBall::append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const {
  const double radius = static_cast<double>(size_) / 2;
  const auto along = [](std::uint64_t step, std::uint64_t steps) {
    return 2 * static_cast<double>(step) / static_cast<double>(steps) - 1;
  };
  for (std::uint64_t v = first; v < first + count; ++v) {
    const GridPoint across = vertices_.at(v % vertices_.count());
    const double x = along(v / vertices_.count(), length_), y = along(across.i, size_), z = along(across.j, size_);
    const double layer = radius * radius_at(z);
    const double place[3] = {layer * x * rounded(y), layer * y * rounded(x), static_cast<double>(across.j) - radius};
    for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(static_cast<double>(static_cast<float>(place[k])));
  }
}

// The tetrahedra of a cube are the paths along its edges from its lowest to its highest corner.
void DrilledBall::append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const {
  static constexpr unsigned kAxes[kTetrahedra][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const std::uint64_t path = cell % kTetrahedra, cube = cell / kTetrahedra;
  const GridPoint across = cubes_.at(cube % cubes_.count());
  std::array<std::uint64_t, 3> at = {cube / cubes_.count(), across.i, across.j};
  const auto corner = [&] { return VertexId(at[0] * vertices_.count() + vertices_.number({at[1], at[2]})); };
  std::array<VertexId, 4> path_corners;
  path_corners[0] = corner();
  for (unsigned step = 0; step < 3; ++step) {
    ++at[kAxes[path][step]];
    path_corners[step + 1] = corner();
  }
  if (path >= 3) std::swap(path_corners[2], path_corners[3]);  // an odd order of the axes
  corners.insert(corners.end(), path_corners.begin(), path_corners.end());
}

}  // namespace reeb::io
