#include "io/generate/grid_surface.h"

#include <algorithm>

#include "io/generate/noise.h"

namespace reeb::io {
namespace {

using Closing = GridLayout::Closing;

constexpr unsigned kTubeTriangles = 8;
constexpr std::uint64_t kPatchCells = 128;  // with two sheets a patch has 64K triangles

std::uint64_t sheet_count(const GridLayout& layout) { return layout.closing == Closing::kTwoSheets ? 2 : 1; }

// Triangles of a cell without the rim. In a hole, the same number of indices goes to the first half of its tube.
std::uint64_t triangles_per_cell(const GridLayout& layout) { return 2 * sheet_count(layout); }

// Cells along the side of a patch.
std::uint64_t patch_side(const GridLayout& layout) {
  const std::uint64_t whole = std::max(layout.width, layout.height) + 1;
  if (layout.order == MeshOrder::kPatches) return kPatchCells;
  if (layout.order == MeshOrder::kRows || layout.order == MeshOrder::kRandom) return whole;
  return std::min(layout.tile_cells, whole);
}

std::uint64_t rim_edges(const GridLayout& layout) {
  return layout.closing == Closing::kTwoSheets ? 2 * (layout.width + layout.height) : 0;
}

// Vertices along an axis with this number of cells.
std::uint64_t axis_vertices(const GridLayout& layout, std::uint64_t cells) {
  return layout.closing == Closing::kTorus ? cells : cells + 1;
}

}  // namespace

std::uint64_t hole_count(const GridLayout& layout) {
  if (layout.closing != Closing::kTwoSheets) return 0;
  return (layout.width >> layout.holes.block_shift) * (layout.height >> layout.holes.block_shift);
}

std::uint64_t triangle_count(const GridLayout& layout) {
  const std::uint64_t tube_extra = kTubeTriangles - triangles_per_cell(layout);
  return layout.width * layout.height * triangles_per_cell(layout) + hole_count(layout) * tube_extra +
         rim_edges(layout) * 2;
}

GridSurface::GridSurface(const GridLayout& layout)
    : layout_(layout),
      sheets_(sheet_count(layout)),
      cells_(layout.width, layout.height, patch_side(layout), 0),
      vertices_(axis_vertices(layout, layout.width), axis_vertices(layout, layout.height), patch_side(layout), 1) {}

ExpectedTopology GridSurface::topology() const {
  ExpectedTopology t;
  t.vertices = vertices_.size() * sheets_;
  t.triangles = triangle_count(layout_);
  t.genus = layout_.closing == Closing::kTorus ? 1 : hole_count(layout_);
  t.boundary_loops = layout_.closing == Closing::kDisc ? 1 : 0;
  t.euler_characteristic = 2 - 2 * static_cast<std::int64_t>(*t.genus) - static_cast<std::int64_t>(*t.boundary_loops);
  t.first_betti = 2 * *t.genus;
  t.max_reeb_loops = *t.genus;
  return t;
}

void GridSurface::append_vertices(std::uint64_t first, std::size_t count, Columns& columns) const {
  for (std::uint64_t v = first; v < first + count;) {
    const auto places = place(vertices_.at(v / sheets_));
    for (std::uint64_t sheet = v % sheets_; sheet < sheets_ && v < first + count; ++sheet, ++v)
      for (std::size_t k = 0; k < 3; ++k) columns[k].push_back(static_cast<double>(places[sheet][k]));
  }
}

void GridSurface::append_cell(std::uint64_t cell, std::vector<VertexId>& corners) const {
  const GridPoint p = cells_.at(cell);
  if (is_hole(p)) {
    for (unsigned k = 0; k < kTubeTriangles; ++k) append_tube_triangle(p, k, corners);
  } else {
    for (unsigned k = 0; k < triangles_per_cell(layout_); ++k) append_sheet_triangle(p, k, corners);
  }
  append_rim_of_cell(p, corners);
}

// The order of indices: the sheet triangles cell by cell, where a hole has the first half of its tube; then the second
// halves of all tubes; then the rim.
void GridSurface::append_triangle(std::uint64_t triangle, std::vector<VertexId>& corners) const {
  const std::uint64_t of_cell = triangles_per_cell(layout_), of_cells = cells_.size() * of_cell;
  if (triangle < of_cells) {
    const GridPoint p = cells_.at(triangle / of_cell);
    const auto k = static_cast<unsigned>(triangle % of_cell);
    return is_hole(p) ? append_tube_triangle(p, k, corners) : append_sheet_triangle(p, k, corners);
  }
  triangle -= of_cells;
  const std::uint64_t half = kTubeTriangles - of_cell;
  if (triangle < hole_count(layout_) * half) {
    const std::uint64_t block = triangle / half, blocks = layout_.width >> layout_.holes.block_shift;
    return append_tube_triangle(hole_in_block({block % blocks, block / blocks}),
                                static_cast<unsigned>(of_cell + triangle % half), corners);
  }
  triangle -= hole_count(layout_) * half;
  append_rim_triangle(triangle / 2, static_cast<unsigned>(triangle % 2), corners);
}

VertexId GridSurface::vertex(GridPoint p, Sheet sheet) const { return VertexId(vertices_.rank(p) * sheets_ + sheet); }

bool GridSurface::is_hole(GridPoint cell) const {
  if (layout_.closing != Closing::kTwoSheets) return false;
  const unsigned shift = layout_.holes.block_shift;
  const GridPoint block{cell.i >> shift, cell.j >> shift};
  const bool whole = block.i < layout_.width >> shift && block.j < layout_.height >> shift;
  return whole && cell == hole_in_block(block);
}

// Never in the first or last line of cells of its block. So holes share no vertex with each other or with the rim.
GridPoint GridSurface::hole_in_block(GridPoint block) const {
  const unsigned shift = layout_.holes.block_shift;
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  GridPoint offset{half, half};
  if (layout_.holes.scattered) {
    const std::uint64_t hash = hash_of(layout_.seed, block.i, block.j);
    offset = {1 + (hash & (half - 1)), 1 + ((hash >> 32) & (half - 1))};
  }
  return {(block.i << shift) + offset.i, (block.j << shift) + offset.j};
}

std::array<GridPoint, 4> GridSurface::corners_of(GridPoint cell) const {
  GridPoint far{cell.i + 1, cell.j + 1};
  if (layout_.closing == Closing::kTorus) {
    if (far.i == layout_.width) far.i = 0;
    if (far.j == layout_.height) far.j = 0;
  }
  return {{cell, {far.i, cell.j}, far, {cell.i, far.j}}};
}

void GridSurface::append_sheet_triangle(GridPoint cell, unsigned k, std::vector<VertexId>& corners) const {
  const auto at = corners_of(cell);
  const Sheet sheet = k < 2 ? kUpper : kLower;
  GridPoint b = at[1 + k % 2], c = at[2 + k % 2];
  if (sheet == kLower) std::swap(b, c);  // the lower sheet faces down
  corners.insert(corners.end(), {vertex(at[0], sheet), vertex(b, sheet), vertex(c, sheet)});
}

void GridSurface::append_tube_triangle(GridPoint hole, unsigned k, std::vector<VertexId>& corners) const {
  const auto at = corners_of(hole);
  const unsigned side = k / 2;
  append_wall_triangle(at[(side + 1) % 4], at[side], k % 2, corners);
}

void GridSurface::append_rim_triangle(std::uint64_t edge, unsigned k, std::vector<VertexId>& corners) const {
  const std::uint64_t width = layout_.width, height = layout_.height;
  if (edge < width) return append_wall_triangle({edge, 0}, {edge + 1, 0}, k, corners);
  edge -= width;
  if (edge < height) return append_wall_triangle({width, edge}, {width, edge + 1}, k, corners);
  edge -= height;
  if (edge < width) return append_wall_triangle({edge + 1, height}, {edge, height}, k, corners);
  edge -= width;
  append_wall_triangle({0, edge + 1}, {0, edge}, k, corners);
}

// The upper sheet uses the edge from p to q, so the wall must use it from q to p.
void GridSurface::append_wall_triangle(GridPoint p, GridPoint q, unsigned k, std::vector<VertexId>& corners) const {
  corners.push_back(vertex(q, kUpper));
  corners.push_back(k == 0 ? vertex(p, kUpper) : vertex(p, kLower));
  corners.push_back(k == 0 ? vertex(p, kLower) : vertex(q, kLower));
}

void GridSurface::append_rim_of_cell(GridPoint cell, std::vector<VertexId>& corners) const {
  if (layout_.closing != Closing::kTwoSheets) return;
  const std::uint64_t width = layout_.width, height = layout_.height;
  const auto append_edge = [&](std::uint64_t edge) {
    append_rim_triangle(edge, 0, corners);
    append_rim_triangle(edge, 1, corners);
  };
  if (cell.j == 0) append_edge(cell.i);
  if (cell.i + 1 == width) append_edge(width + cell.j);
  if (cell.j + 1 == height) append_edge(width + height + cell.i);
  if (cell.i == 0) append_edge(2 * width + height + cell.j);
}

}  // namespace reeb::io
