// Numbers the points of a grid patch by patch, with a closed form in both directions.
#pragma once

#include <algorithm>
#include <cstdint>

namespace reeb::io {

struct GridPoint {
  std::uint64_t i = 0, j = 0;  // column, row
  friend bool operator==(const GridPoint&, const GridPoint&) = default;
};

// One axis, cut into intervals of `interval` points; the first is longer by `lead`. With lead 0 these are the cells of
// the patches. With lead 1 they are the vertices that each patch is the first to use, since a patch shares its first
// line of vertices with the patch before.
class CutAxis {
 public:
  CutAxis(std::uint64_t size, std::uint64_t interval, std::uint64_t lead)
      : size_(size), interval_(interval), lead_(lead) {}
  std::uint64_t size() const { return size_; }
  std::uint64_t patch_of(std::uint64_t x) const { return x < lead_ ? 0 : (x - lead_) / interval_; }
  std::uint64_t begin(std::uint64_t patch) const { return patch == 0 ? 0 : patch * interval_ + lead_; }
  std::uint64_t patch_count() const { return size_ == 0 ? 0 : patch_of(size_ - 1) + 1; }
  std::uint64_t end(std::uint64_t patch) const { return std::min(size_, (patch + 1) * interval_ + lead_); }

 private:
  std::uint64_t size_;
  std::uint64_t interval_;
  std::uint64_t lead_;
};

// Rows of patches from below, patches of a row from the left, points of a patch row by row. A patch
// at least as large as the grid gives plain row order.
class PatchedGrid {
 public:
  // REQUIRES: side >= 1.
  PatchedGrid(std::uint64_t columns, std::uint64_t rows, std::uint64_t side, std::uint64_t lead)
      : columns_(columns, side, lead), rows_(rows, side, lead) {}

  std::uint64_t size() const { return columns_.size() * rows_.size(); }

  std::uint64_t patch_count() const { return columns_.patch_count() * rows_.patch_count(); }
  // The first rank of a patch. Patches are numbered in the order of ranks; one more than there are gives size().
  std::uint64_t patch_begin(std::uint64_t patch) const {
    const std::uint64_t across = columns_.patch_count(), x = patch % across, y = patch / across;
    if (y == rows_.patch_count()) return size();
    const std::uint64_t row = rows_.begin(y);
    return row * columns_.size() + columns_.begin(x) * (rows_.end(y) - row);
  }
  // Whether the point is in the last row or column of its patch, and another patch follows there.
  bool is_at_seam(GridPoint p) const {
    return (p.i + 1 < columns_.size() && columns_.patch_of(p.i + 1) != columns_.patch_of(p.i)) ||
           (p.j + 1 < rows_.size() && rows_.patch_of(p.j + 1) != rows_.patch_of(p.j));
  }

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
