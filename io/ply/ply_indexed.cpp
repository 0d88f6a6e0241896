#include "io/ply/ply_indexed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "io/file/content_source.h"
#include "io/file/file_windows.h"
#include "io/mesh/property_columns.h"
#include "io/mesh/scalar_bytes.h"
#include "io/ply/ply_reader.h"
#include "io/text/cursor.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kMaxRecordBytes = 4096;
// Many small windows, since the vertices of a chunk are in several places of the file.
constexpr WindowOptions windows_of(std::size_t record_bytes) {
  return {.window_bits = 16, .window_count = 16, .overlap_bytes = record_bytes};
}

struct Column {
  ScalarType type = ScalarType::kFloat32;
  std::size_t offset = 0;  // in the record
  bool carried = false;    // it may have any values
};

// Of all properties.
std::vector<Column> all_columns(const PlyHeader& header) {
  std::vector<Column> all;
  std::size_t offset = 0;
  for (const PlyProperty& property : header.vertices().properties) {
    all.push_back({property.type, offset});
    offset += byte_size(property.type);
  }
  return all;
}

std::vector<Column> find_columns(const PlyHeader& header, const ReadOptions& options, const std::vector<bool>& carried,
                                 const std::string& file) {
  const std::vector<Column> all = all_columns(header);
  std::vector<Column> columns;
  for (const std::size_t p : header.coordinate_properties()) columns.push_back(all[p]);
  for (const std::size_t p : header.find_properties(options.properties, file)) columns.push_back(all[p]);
  for (std::size_t k = 0; k < columns.size(); ++k) columns[k].carried = carried[k];
  return columns;
}

class IndexedPly final : public IndexedMesh {
 public:
  IndexedPly(std::shared_ptr<const InputFile> file, const PlyHeader& header, const ReadOptions& options,
             const std::vector<bool>& carried)
      : path_(file->path()),
        header_(header),
        columns_(find_columns(header_, options, carried, path_)),
        swap_(header_.encoding == PlyEncoding::kBigEndian),
        stride_(header_.vertices().fixed_bytes()),
        vertices_begin_(header_.body_offset),
        windows_(file, windows_of(stride_)),
        faces_(open_ply_faces(open_content(std::move(file)), header_)) {
    for (std::size_t i = 0; i < header_.vertex_element; ++i)
      vertices_begin_ += header_.elements[i].count * header_.elements[i].fixed_bytes();
  }

  std::uint64_t vertex_count() const override { return header_.vertices().count; }
  unsigned column_count() const override { return static_cast<unsigned>(columns_.size()); }

  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    const bool plain =
        !swap_ && std::ranges::all_of(columns, [this](unsigned c) { return columns_[c].type == ScalarType::kFloat32; });
    if (plain && columns.size() == 1)
      gather_floats<1>(ids, columns, values);
    else if (plain && columns.size() == 3)
      gather_floats<3>(ids, columns, values);
    else if (plain && columns.size() == 4)
      gather_floats<4>(ids, columns, values);
    else
      gather_any(ids, columns, values);
    if (!all_finite(values)) check_finite(ids, columns, values);
  }

  void rewind() override {
    faces_->move_to_faces();
    reading_ = faces_.get();
    triangles_read_ = 0;
  }

  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    corners.clear();
    batch_.triangles().swap(corners);
    reading_->set_batch_events(limit);
    const bool more = reading_->read(batch_);
    batch_.triangles().swap(corners);
    if (reading_ == faces_.get()) count(corners.size() / 3, !more);
    return more;
  }
  SimplexCounts simplex_counts() const override { return counts_; }

  std::optional<MeshPlace> place() const override { return reading_->place(); }
  void seek(const MeshPlace& place) override { pieces().seek(place); }

  std::optional<std::uint64_t> triangles_by_size() const override {
    return triangles_ ? std::optional(triangles_->count) : std::nullopt;
  }
  void seek_triangle(std::uint64_t number) override { pieces().seek_triangle(*triangles_, number); }

  std::uint64_t bytes_read() const override { return reading_->bytes_read(); }
  std::uint64_t bytes_total() const override { return windows_.size(); }
  std::vector<std::string> warnings() const override {
    if (!non_finite_values_) non_finite_values_ = count_non_finite_values();
    std::vector<std::string> lines;
    if (*non_finite_values_ != 0) lines.push_back(note_on_non_finite_values(*non_finite_values_));
    std::vector<std::string> others = reading_->warnings();
    std::ranges::move(others, std::back_inserter(lines));
    return lines;
  }

 private:
  PlyBodyReader& pieces() {
    if (pieces_ == nullptr) pieces_ = open_ply_faces(open_for_seeking(windows_.file()), header_);
    reading_ = pieces_.get();
    return *pieces_;
  }

  void count(std::uint64_t triangles, bool at_end) {
    triangles_read_ += triangles;
    if (!at_end) return;
    const auto [points, edges] = faces_->points_and_edges();
    counts_ = {points, edges, triangles_read_ - points - edges};
  }

  // Of the properties that may have any values. Vertices are looked up without these, so this is a pass of its own.
  std::uint64_t count_non_finite_values() const {
    std::vector<Column> unused = all_columns(header_);
    std::erase_if(unused, [this](const Column& column) {
      return !is_float(column.type) || std::ranges::any_of(columns_, [&column](const Column& used) {
        return !used.carried && used.offset == column.offset;
      });
    });
    std::uint64_t left = unused.empty() ? 0 : vertex_count(), non_finite = 0;
    if (left == 0) return 0;
    Cursor records(open_content(windows_.file()));
    records.move_to(vertices_begin_);
    while (left != 0 && records.ensure(stride_)) {
      const std::uint64_t count = std::min<std::uint64_t>(left, records.available() / stride_);
      for (const Column& column : unused)
        with_type(column.type, [&](auto zero) {
          const char* bytes = records.data() + column.offset;
          for (std::uint64_t i = 0; i < count; ++i, bytes += stride_)
            non_finite += std::isfinite(static_cast<double>(load_scalar<decltype(zero)>(bytes, swap_))) ? 0u : 1u;
        });
      records.advance(static_cast<std::size_t>(count * stride_));
      left -= count;
    }
    return non_finite;
  }

  const char* record(VertexId id) { return windows_.at(vertices_begin_ + id.value() * stride_); }

  // For little-endian float32 and a number of columns that is known at compile time.
  template <std::size_t kColumns>
  void gather_floats(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) {
    std::array<std::size_t, kColumns> place{};
    for (std::size_t k = 0; k < kColumns; ++k) place[k] = columns_[columns[k]].offset;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const char* const bytes = record(ids[i]);
      for (std::size_t k = 0; k < kColumns; ++k)
        values[k * ids.size() + i] = static_cast<double>(load_scalar<float>(bytes + place[k], false)) + 0.0;
    }
  }

  void gather_any(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const Column& column = columns_[columns[k]];
      double* const out = values.data() + k * ids.size();
      with_type(column.type, [&](auto zero) {
        for (std::size_t i = 0; i < ids.size(); ++i)
          out[i] = static_cast<double>(load_scalar<decltype(zero)>(record(ids[i]) + column.offset, swap_)) + 0.0;
      });
    }
  }

  void check_finite(std::span<const VertexId> ids, std::span<const unsigned> columns,
                    std::span<const double> values) const {
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < ids.size() && !columns_[columns[k]].carried; ++i)
        if (!std::isfinite(values[k * ids.size() + i])) fail_not_finite(ids[i], columns[k]);
  }

  [[noreturn]] void fail_not_finite(VertexId id, unsigned column) const {
    throw Error(ErrorKind::kBadInput,
                std::string("a ") + (column < header_.dimension ? "coordinate" : "vertex property") + " of vertex " +
                    std::to_string(id.value()) + " is not finite",
                "fix this value in the file")
        .at(path_, std::to_string(vertices_begin_ + id.value() * stride_ + columns_[column].offset));
  }

  std::string path_;
  PlyHeader header_;
  std::vector<Column> columns_;
  bool swap_;
  std::size_t stride_;
  std::uint64_t vertices_begin_;
  FileWindows windows_;
  std::optional<PlyTriangles> triangles_ = header_.triangles_by_size(windows_.size());
  std::unique_ptr<PlyBodyReader> faces_;   // from the first to the last
  std::unique_ptr<PlyBodyReader> pieces_;  // from places on; null before the first seek()
  PlyBodyReader* reading_ = faces_.get();
  MeshBatch batch_;
  std::uint64_t triangles_read_ = 0;  // of `faces_`
  SimplexCounts counts_{};
  mutable std::optional<std::uint64_t> non_finite_values_;  // once they were counted
};

}  // namespace

bool has_indexed_vertices(const PlyHeader& header) {
  if (header.encoding == PlyEncoding::kAscii) return false;
  if (header.vertices().has_lists() || header.vertices().fixed_bytes() > kMaxRecordBytes) return false;
  // Faces have no fixed size, and neither have other elements with lists.
  return std::none_of(header.elements.begin(),
                      header.elements.begin() + static_cast<std::ptrdiff_t>(header.vertex_element),
                      [](const PlyElement& element) { return element.has_lists(); });
}

std::unique_ptr<IndexedMesh> index_ply(std::shared_ptr<const InputFile> file, const PlyHeader& header,
                                       const ReadOptions& options, const std::vector<bool>& carried) {
  return std::make_unique<IndexedPly>(std::move(file), header, options, carried);
}

}  // namespace reeb::io
