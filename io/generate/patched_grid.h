// Numbers the points of a grid patch by patch, with a closed form in both directions.
#pragma once

#include <algorithm>
#include <cstdint>

namespace reeb::io {

struct GridPoint {
  std::uint64_t i = 0, j = 0;  // column, row
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

// One axis, cut into intervals of 2^shift points; the first is longer by `lead`. With lead 0 these are the cells of the
// patches. With lead 1 they are the vertices that each patch is the first to use, since a patch shares its first line
// of vertices with the patch before.
class CutAxis {
 public:
  CutAxis(std::uint64_t size, unsigned shift, std::uint64_t lead) : size_(size), shift_(shift), lead_(lead) {}
  std::uint64_t size() const { return size_; }
  std::uint64_t patch_of(std::uint64_t x) const { return x < lead_ ? 0 : (x - lead_) >> shift_; }
  std::uint64_t begin(std::uint64_t patch) const { return patch == 0 ? 0 : (patch << shift_) + lead_; }
  std::uint64_t end(std::uint64_t patch) const { return std::min(size_, ((patch + 1) << shift_) + lead_); }

 private:
  std::uint64_t size_;
  unsigned shift_;
  std::uint64_t lead_;
};

// Rows of patches from below, patches of a row from the left, points of a patch row by row. A patch
// at least as large as the grid gives plain row order.
class PatchedGrid {
 public:
  PatchedGrid(std::uint64_t columns, std::uint64_t rows, unsigned shift, std::uint64_t lead)
      : columns_(columns, shift, lead), rows_(rows, shift, lead) {}

  std::uint64_t size() const { return columns_.size() * rows_.size(); }

  std::uint64_t rank(GridPoint p) const {
    const Patch patch = patch_of(p);
    return patch.y * columns_.size() + patch.x * patch.height + (p.j - patch.y) * patch.width + (p.i - patch.x);
  }

  GridPoint at(std::uint64_t rank) const {
    const std::uint64_t columns = columns_.size();
    // A row of patches has one rank per point of its rows, so this quotient is a row inside it.
    const std::uint64_t patch_row = rows_.patch_of(rank / columns);
    const std::uint64_t y = rows_.begin(patch_row), height = rows_.end(patch_row) - y;
    rank -= y * columns;
    const std::uint64_t patch_column = columns_.patch_of(rank / height);
    const std::uint64_t x = columns_.begin(patch_column), width = columns_.end(patch_column) - x;
    rank -= x * height;
    return {x + rank % width, y + rank / width};
  }

 private:
  struct Patch {
    std::uint64_t x, y, width, height;
  };
  Patch patch_of(GridPoint p) const {
    const std::uint64_t column = columns_.patch_of(p.i), row = rows_.patch_of(p.j);
    const std::uint64_t x = columns_.begin(column), y = rows_.begin(row);
    return {x, y, columns_.end(column) - x, rows_.end(row) - y};
  }

  CutAxis columns_, rows_;
};

}  // namespace reeb::io
