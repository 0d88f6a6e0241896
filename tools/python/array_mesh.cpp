#include "tools/python/array_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "io/mesh/property_columns.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/port/deciding_triangles.h"

namespace reeb::python {
namespace {

struct Column {
  std::string name;  // of its array
  StridedArray array;
  std::uint64_t index = 0;
};

std::vector<Column> choose_columns(const ArrayMesh& mesh, const ReadOptions& options) {
  std::vector<Column> columns;
  for (std::uint64_t k = 0; k < mesh.vertices.size[1]; ++k) columns.push_back({"vertices", mesh.vertices, k});
  const auto add = [&](const ArrayMesh::Property& property) { columns.push_back({property.name, property.values, 0}); };
  if (options.all_properties) std::ranges::for_each(mesh.properties, add);
  for (const std::string& name : options.properties) {
    const auto found = std::ranges::find(mesh.properties, name, &ArrayMesh::Property::name);
    if (found == mesh.properties.end())
      throw Error(ErrorKind::kBadInput, "there are no values of the name \"" + name + '"',
                  "pass them: values={\"" + name + "\": array}");
    add(*found);
  }
  return columns;
}

std::vector<std::string> rounding_notes(std::span<const Column> columns) {
  std::uint64_t rounded = 0;
  for (const Column& column : columns) rounded += column.array.rounded(column.index);
  if (rounded == 0) return {};
  return {io::note_on_rounded_values(rounded)};
}

// values[i] = that of vertex id(i).
template <class IdOf>
void copy_column(const Column& column, std::size_t count, double* values, const IdOf& id) {
  const char* const data = column.array.at(0, column.index);
  const std::int64_t stride = column.array.stride[0];
  io::with_type(column.array.type, [&](auto zero) {
    for (std::size_t i = 0; i < count; ++i)
      values[i] = static_cast<double>(
                      io::load_scalar<decltype(zero)>(data + static_cast<std::int64_t>(id(i)) * stride, false)) +
                  0.0;
  });
  if (io::all_finite(std::span(values, count))) return;
  const auto non_finite = std::find_if(values, values + count, [](double value) { return !std::isfinite(value); });
  const std::uint64_t vertex = id(static_cast<std::size_t>(non_finite - values));
  const bool is_row = column.array.size[1] > 1 || column.name == "vertices";
  throw Error(ErrorKind::kBadInput, is_row ? "a coordinate is not finite" : "a value is not finite",
              "give every vertex finite numbers")
      .at(kNoFile, place_in(column.name, std::to_string(vertex) + (is_row ? ", " + std::to_string(column.index) : "")));
}

// Goes through the rows of all arrays of simplices.
class SimplexRows {
 public:
  explicit SimplexRows(const ArrayMesh& mesh) : mesh_(mesh) {}

  bool at_end() const { return array_ == mesh_.simplices.size(); }
  const ArrayMesh::Simplices& array() const { return mesh_.simplices[array_]; }
  std::uint64_t row() const { return row_; }
  std::uint64_t bytes_read() const { return bytes_; }
  // REQUIRES: as row() and the position of array() were at an earlier time.
  void move_to(const MeshPlace& place) {
    array_ = static_cast<std::size_t>(place.first);
    row_ = place.second;
    bytes_ = 0;
    for (std::size_t i = 0; i < array_; ++i) bytes_ += bytes_of(mesh_.simplices[i].corners);
    if (!at_end()) bytes_ += row_ * row_bytes(array().corners);
    skip_empty();
  }
  MeshPlace place() const { return {array_, row_}; }

  // Appends the corners of the next rows of one array, at most `limit`, and returns their number.
  // REQUIRES: !at_end().
  std::size_t take(std::size_t limit, std::vector<VertexId>& corners) {
    const StridedArray& rows = array().corners;
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(limit, rows.size[0] - row_));
    const auto width = static_cast<std::size_t>(rows.size[1]);
    const std::size_t begin = corners.size();
    corners.resize(begin + count * width);
    const std::uint64_t vertices = mesh_.vertices.size[0];
    std::uint64_t largest = 0;  // of negative numbers, too: they are the largest
    io::with_type(rows.type, [&](auto zero) {
      VertexId* out = corners.data() + begin;
      for (std::size_t i = 0; i < count; ++i) {
        const char* item = rows.at(row_ + i, 0);
        for (std::size_t k = 0; k < width; ++k, item += rows.stride[1]) {
          const auto id = static_cast<std::uint64_t>(io::load_scalar<decltype(zero)>(item, false));
          largest = std::max(largest, id);
          *out++ = VertexId(id);
        }
      }
    });
    if (largest >= vertices && count != 0) fail(std::span(corners).subspan(begin));
    row_ += count;
    bytes_ += count * row_bytes(rows);
    skip_empty();
    return count;
  }

  static std::uint64_t row_bytes(const StridedArray& rows) { return rows.size[1] * io::byte_size(rows.type); }
  static std::uint64_t bytes_of(const StridedArray& rows) { return rows.size[0] * row_bytes(rows); }

 private:
  void skip_empty() {
    while (!at_end() && row_ == array().corners.size[0]) {
      ++array_;
      row_ = 0;
    }
  }
  [[noreturn]] void fail(std::span<const VertexId> corners) const {
    const std::uint64_t vertices = mesh_.vertices.size[0], width = array().corners.size[1];
    const auto bad = std::ranges::find_if(corners, [&](VertexId id) { return id.value() >= vertices; });
    const auto index = static_cast<std::uint64_t>(bad - corners.begin());
    const std::string name = array().corners.type == io::ScalarType::kUint64
                                 ? std::to_string(bad->value())
                                 : std::to_string(static_cast<std::int64_t>(bad->value()));
    throw Error(ErrorKind::kBadInput, "names vertex " + name + ", but there are " + count_of(vertices, "vertex"),
                "vertices are numbered from 0")
        .at(kNoFile,
            place_in(array().name, std::to_string(row_ + index / width) + ", " + std::to_string(index % width)));
  }

  const ArrayMesh& mesh_;
  std::size_t array_ = 0;
  std::uint64_t row_ = 0, bytes_ = 0;
};

std::uint64_t total_bytes(const ArrayMesh& mesh) {
  std::uint64_t bytes = 0;
  for (const ArrayMesh::Simplices& array : mesh.simplices) bytes += SimplexRows::bytes_of(array.corners);
  return bytes;
}

class IndexedArrays final : public IndexedMesh {
 public:
  IndexedArrays(std::shared_ptr<const ArrayMesh> mesh, std::vector<Column> columns)
      : mesh_(std::move(mesh)), columns_(std::move(columns)), rows_(*mesh_) {
    rewind();
    has_cells_ = std::ranges::any_of(mesh_->simplices, [](const auto& array) { return array.corners.size[1] > 3; });
  }

  std::uint64_t vertex_count() const override { return mesh_->vertices.size[0]; }
  unsigned column_count() const override { return static_cast<unsigned>(columns_.size()); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    for (std::size_t k = 0; k < columns.size(); ++k)
      copy_column(columns_[columns[k]], ids.size(), values.data() + k * ids.size(),
                  [&](std::size_t i) { return ids[i].value(); });
  }
  void rewind() override {
    rows_.move_to({});
    deciding_ = DecidingTriangles();
    forget_waiting();
  }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    corners.clear();
    while (corners.empty() && (has_waiting() || !rows_.at_end())) {
      if (has_waiting()) {
        take_waiting(limit, corners);
        continue;
      }
      const auto width = static_cast<std::size_t>(rows_.array().corners.size[1]);
      if (width == 3) {
        rows_.take(limit, corners);
        continue;
      }
      taken_.clear();
      rows_.take(std::min(limit, kRowsAtOnce), taken_);
      forget_waiting();
      add_triangles(width, waiting_);
    }
    return !corners.empty();
  }
  SimplexCounts simplex_counts() const override {
    SimplexCounts counts{};
    for (const ArrayMesh::Simplices& array : mesh_->simplices)
      counts[static_cast<std::size_t>(array.corners.size[1]) - 1] += array.corners.size[0];
    return counts;
  }
  // Which triangles cells share depends on the cells before.
  std::optional<MeshPlace> place() const override { return has_cells_ ? std::nullopt : std::optional(rows_.place()); }
  void seek(const MeshPlace& place) override {
    rows_.move_to(place);
    forget_waiting();
  }
  std::uint64_t bytes_read() const override { return rows_.bytes_read(); }
  std::uint64_t bytes_total() const override { return total_bytes(*mesh_); }
  std::vector<std::string> warnings() const override { return rounding_notes(columns_); }

 private:
  void add_triangles(std::size_t width, std::vector<VertexId>& corners) {
    for (std::size_t i = 0; i < taken_.size(); i += width) {
      const auto simplex = std::span(taken_).subspan(i, width);
      std::sort(simplex.begin(), simplex.end());
      const auto end = std::unique(simplex.begin(), simplex.end());
      deciding_.of_simplex(simplex.first(static_cast<std::size_t>(end - simplex.begin())),
                           [&](VertexId a, VertexId b, VertexId c) {
                             corners.insert(corners.end(), {a, b, c});
                           });
    }
  }

  // A row has up to 28 deciding triangles, and a call may return fewer.
  bool has_waiting() const { return read_ != waiting_.size(); }
  void take_waiting(std::size_t limit, std::vector<VertexId>& corners) {
    const std::size_t count = std::min(3 * limit, waiting_.size() - read_);
    corners.assign(waiting_.begin() + static_cast<std::ptrdiff_t>(read_),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(read_ + count));
    read_ += count;
  }
  void forget_waiting() {
    waiting_.clear();
    read_ = 0;
  }

  static constexpr std::size_t kRowsAtOnce = 1024;

  std::shared_ptr<const ArrayMesh> mesh_;
  std::vector<Column> columns_;
  SimplexRows rows_;
  DecidingTriangles deciding_;
  std::vector<VertexId> taken_;
  std::vector<VertexId> waiting_;  // triangles of rows that were taken, and how many corners of them were read
  std::size_t read_ = 0;
  bool has_cells_ = false;
};

class ArrayReader final : public MeshReader {
 public:
  ArrayReader(std::shared_ptr<const ArrayMesh> mesh, const ReadOptions& options)
      : mesh_(std::move(mesh)),
        columns_(choose_columns(*mesh_, options)),
        at_once_(std::max<std::size_t>(options.batch_events, 1)),
        rows_(*mesh_) {
    rows_.move_to({});
    info_.format = "arrays";
    info_.dimension = static_cast<unsigned>(mesh_->vertices.size[1]);
    for (const ArrayMesh::Property& property : mesh_->properties) info_.property_names.push_back(property.name);
    info_.vertex_count = mesh_->vertices.size[0];
    info_.simplex_count = 0;
    for (const ArrayMesh::Simplices& array : mesh_->simplices) *info_.simplex_count += array.corners.size[0];
    info_.float32 = std::ranges::all_of(
        columns_, [](const Column& column) { return column.array.type == io::ScalarType::kFloat32; });
    info_.file_bytes = total_bytes(*mesh_);
  }

  const MeshInfo& info() const override { return info_; }
  std::unique_ptr<IndexedMesh> indexed() const override { return std::make_unique<IndexedArrays>(mesh_, columns_); }
  std::uint64_t bytes_read() const override { return rows_.bytes_read(); }
  std::vector<std::string> warnings() const override { return rounding_notes(columns_); }
  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.first_vertex = VertexId(next_);
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(at_once_, mesh_->vertices.size[0] - next_));
    if (count != 0) {
      batch.coordinates.resize(info_.dimension);
      batch.properties.resize(columns_.size() - info_.dimension);
      batch.vertex_count = count;
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        batch.column(k).resize(count);
        copy_column(columns_[k], count, batch.column(k).data(), [&](std::size_t i) { return next_ + i; });
      }
      next_ += count;
    } else if (!rows_.at_end()) {
      rows_.take(at_once_, batch.simplices[static_cast<std::size_t>(rows_.array().corners.size[1]) - 1]);
    }
    return !batch.empty();
  }

 private:
  std::shared_ptr<const ArrayMesh> mesh_;
  std::vector<Column> columns_;
  std::size_t at_once_;
  SimplexRows rows_;
  MeshInfo info_;
  std::uint64_t next_ = 0;
};

}  // namespace

std::unique_ptr<MeshReader> read_arrays(std::shared_ptr<const ArrayMesh> mesh, const ReadOptions& options) {
  return std::make_unique<ArrayReader>(std::move(mesh), options);
}

}  // namespace reeb::python
