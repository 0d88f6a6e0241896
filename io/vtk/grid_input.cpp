#include "io/vtk/grid_input.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/mesh/property_columns.h"
#include "io/text/hints.h"
#include "io/vtk/number_stream.h"
#include "io/vtk/vtk_cell_type.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

MeshInfo describe(const ContentSource& content, const GridFile& file) {
  MeshInfo info;
  info.format = file.format;
  info.vertex_count = info.simplex_count = 0;
  info.float32 = true;
  for (const GridPiece& piece : file.pieces) {
    *info.vertex_count += piece.points;
    for (const CellList& list : piece.cells) *info.simplex_count += list.count;
    info.float32 &= fits_float32(piece.coordinates.type);
    for (const PlacedPointArray& array : piece.arrays) info.float32 &= fits_float32(array.place.type);
  }
  if (!file.pieces.empty()) {
    const auto& arrays = file.pieces.front().arrays;
    info.property_names = property_names(std::vector<PointArray>(arrays.begin(), arrays.end()));
  }
  info.file_bytes = file.packed_bytes != 0 ? file.packed_bytes : content.file_bytes();
  return info;
}

// One component of an array of values at points.
class ValueColumn {
 public:
  ValueColumn(const ContentSource& content, const PlacedPointArray& array, std::uint64_t component,
              std::uint64_t points)
      : numbers_(content, array.place, points * array.components, "vertex property"),
        before_(component),
        after_(array.components - component - 1) {}

  double next() {
    numbers_.skip(before_);
    const double value = numbers_.real();
    if (!std::isfinite(value)) numbers_.fail("a vertex property is not finite", "fix this value in the file");
    numbers_.skip(after_);
    return value;
  }
  std::uint64_t memory_bytes() const { return numbers_.memory_bytes(); }
  std::uint64_t rounded() const { return numbers_.rounded(); }

 private:
  NumberStream numbers_;
  std::uint64_t before_, after_;
};

class GridInput final : public CellInput {
 public:
  GridInput(std::shared_ptr<const ContentSource> content, std::shared_ptr<const GridFile> file,
            const ReadOptions& options)
      : content_(std::move(content)),
        file_(std::move(file)),
        properties_(options.properties),
        info_(describe(*content_, *file_)) {
    if (file_->pieces.empty() && !properties_.empty()) find_point_column({}, properties_.front(), content_->name());
    if (!file_->pieces.empty()) open_piece();
  }

  const MeshInfo& info() const override { return info_; }
  bool has_inner_nodes() const override { return file_->has_inner_nodes; }

  Step next(CellHead& cell) override {
    for (; piece_ < file_->pieces.size(); next_piece()) {
      if (points_left_ != 0) return Step::kVertices;
      for (; list_ < piece().cells.size(); next_list()) {
        if (!list_open_) open_list();
        if (cells_left_ == 0) continue;
        --cells_left_;
        cell = read_head();
        return Step::kCell;
      }
    }
    return Step::kEnd;
  }

  std::size_t read_vertices(std::span<std::vector<double>* const> columns, std::size_t limit) override {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(limit, points_left_));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double value = coordinates_->real();
        if (!std::isfinite(value)) coordinates_->fail("a coordinate is not finite", "fix this vertex, or remove it");
        columns[k]->push_back(value);
      }
      for (std::size_t k = 0; k < values_.size(); ++k) columns[3 + k]->push_back(values_[k]->next());
    }
    points_left_ -= count;
    bytes_read_ = std::max(bytes_read_, coordinates_->bytes_read());
    return count;
  }

  VertexId read_node() override {
    const std::int64_t node = nodes_->integer();
    if (node < 0 || static_cast<std::uint64_t>(node) >= piece().points) [[unlikely]]
      nodes_->fail(
          "a cell names point " + std::to_string(node) + ", but there are only " + count_of(piece().points, "point"),
          "points are numbered from 0; the file may be damaged here");
    return VertexId(first_point_ + static_cast<std::uint64_t>(node));
  }

  std::uint64_t bytes_read() const override {
    const std::uint64_t bytes = std::max(bytes_read_, nodes_ ? nodes_->bytes_read() : std::uint64_t{0});
    if (file_->packed_bytes == 0) return bytes;
    const double share = static_cast<double>(bytes) / static_cast<double>(content_->file_bytes());
    return static_cast<std::uint64_t>(share * static_cast<double>(file_->packed_bytes));
  }
  std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = coordinates_ ? coordinates_->memory_bytes() : 0;
    for (const auto& column : values_) bytes += column->memory_bytes();
    for (const auto* numbers : {&nodes_, &offsets_, &types_}) bytes += *numbers ? (*numbers)->memory_bytes() : 0;
    return bytes;
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> lines;
    if (file_->has_later_steps) lines.emplace_back("the file has several time steps; only the first one was read");
    std::uint64_t rounded = rounded_;
    for (const auto& column : values_) rounded += column->rounded();
    if (rounded != 0) lines.push_back(note_on_rounded_values(rounded));
    return lines;
  }

 private:
  const GridPiece& piece() const { return file_->pieces[piece_]; }
  const CellList& list() const { return piece().cells[list_]; }

  void open_piece() {
    const GridPiece& next = piece();
    points_left_ = next.points;
    list_ = 0;
    coordinates_.reset();
    for (const auto& column : values_) rounded_ += column->rounded();
    values_.clear();
    const std::vector<PointArray> arrays(next.arrays.begin(), next.arrays.end());
    for (const std::string& property : properties_) {
      const auto [array, component] = find_point_column(arrays, property, content_->name());
      if (points_left_ != 0)
        values_.push_back(std::make_unique<ValueColumn>(*content_, next.arrays[array], component, next.points));
    }
    if (points_left_ != 0) coordinates_.emplace(*content_, next.coordinates, 3 * next.points, "coordinate");
  }

  void next_piece() {
    first_point_ += piece().points;
    if (++piece_ < file_->pieces.size()) open_piece();
  }

  void open_list() {
    const CellList& next = list();
    cells_left_ = next.count;
    list_open_ = true;
    nodes_read_ = 0;
    if (next.count == 0) return;
    coordinates_.reset();  // the cells come after all points of the piece
    values_.clear();
    nodes_.emplace(*content_, next.nodes, next.node_numbers, "point number");
    if (next.layout != CellLayout::kCounted)
      offsets_.emplace(*content_, next.offsets, next.count + (next.layout == CellLayout::kOffsetsFromZero ? 1 : 0),
                       "cell offset");
    if (next.has_types) types_.emplace(*content_, next.types, next.count, "cell type");
    if (next.layout == CellLayout::kOffsetsFromZero && offsets_->integer() != 0)
      offsets_->fail("the offsets of the cells do not begin with 0", kDamagedHereHint);
  }

  void next_list() {
    if (list().count != 0 && list().layout == CellLayout::kCounted && nodes_read_ != list().node_numbers)
      nodes_->fail("the list of cells announces " + count_of(list().node_numbers, "number") + ", but its cells have " +
                       with_commas(nodes_read_),
                   kDamagedHereHint);
    if (nodes_) bytes_read_ = std::max(bytes_read_, nodes_->bytes_read());
    nodes_.reset();
    offsets_.reset();
    types_.reset();
    list_open_ = false;
    ++list_;
  }

  CellHead read_head() {
    const std::uint64_t nodes = list().layout == CellLayout::kCounted ? counted_nodes() : nodes_to_offset();
    if (!list().has_types) {
      const std::uint64_t fixed = corner_count(list().shape);
      return {list().shape, fixed != 0 ? fixed : nodes, 0};
    }
    const std::int64_t type = types_->integer();
    try {
      return vtk_cell(type, nodes);
    } catch (const Error& error) {
      types_->fail(error.message(), error.hint());
    }
  }

  std::uint64_t counted_nodes() {
    const std::int64_t count = nodes_->integer();
    const std::uint64_t left = list().node_numbers - std::min(nodes_read_ + 1, list().node_numbers);
    if (count < 0 || static_cast<std::uint64_t>(count) > left)
      nodes_->fail(
          "a cell has " + std::to_string(count) + " nodes, but its list only has " + count_of(left, "number") + " left",
          kDamagedHereHint);
    nodes_read_ += 1 + static_cast<std::uint64_t>(count);
    return static_cast<std::uint64_t>(count);
  }

  std::uint64_t nodes_to_offset() {
    const std::int64_t end = offsets_->integer();
    const bool beyond = list().layout == CellLayout::kOffsetsFromZero && end >= 0 &&
                        static_cast<std::uint64_t>(end) > list().node_numbers;
    if (end < 0 || static_cast<std::uint64_t>(end) < nodes_read_ || beyond)
      offsets_->fail("a cell ends at " + std::to_string(end) +
                         (beyond ? ", but the list has only " + count_of(list().node_numbers, "node")
                                 : ", before the cell before it, which ends at " + std::to_string(nodes_read_)),
                     kDamagedHereHint);
    return static_cast<std::uint64_t>(end) - std::exchange(nodes_read_, static_cast<std::uint64_t>(end));
  }

  std::shared_ptr<const ContentSource> content_;
  std::shared_ptr<const GridFile> file_;
  std::vector<std::string> properties_;
  MeshInfo info_;

  std::size_t piece_ = 0, list_ = 0;
  std::uint64_t first_point_ = 0, points_left_ = 0;
  std::uint64_t rounded_ = 0;  // values of earlier pieces
  std::optional<NumberStream> coordinates_;
  std::vector<std::unique_ptr<ValueColumn>> values_;

  bool list_open_ = false;
  std::uint64_t cells_left_ = 0;
  std::uint64_t nodes_read_ = 0;  // numbers of the list `nodes` up to the end of the current cell
  std::optional<NumberStream> nodes_, offsets_, types_;
  std::uint64_t bytes_read_ = 0;
};

}  // namespace

std::unique_ptr<CellInput> open_grid_input(std::shared_ptr<const ContentSource> content,
                                           std::shared_ptr<const GridFile> file, const ReadOptions& options) {
  return std::make_unique<GridInput>(std::move(content), std::move(file), options);
}

bool has_higher_order_cells(const ContentSource& content, const GridFile& file) {
  for (const GridPiece& piece : file.pieces) {
    for (const CellList& list : piece.cells) {
      if (!list.has_types || list.count == 0) continue;
      NumberStream types(content, list.types, list.count, "cell type");
      for (std::uint64_t i = 0; i < list.count; ++i)
        if (has_inner_nodes(types.integer())) return true;
    }
  }
  return false;
}

}  // namespace reeb::io
