#include "io/ply/ply_writer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "io/mesh/sectioned_file.h"
#include "io/mesh/written_records.h"
#include "io/text/number_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

static_assert(std::endian::native == std::endian::little, "records are copied as they lie in memory");

constexpr std::uint64_t kMaxVertices = std::uint64_t{1} << 32;
constexpr std::size_t kMaxFaceBytes = 1 + 3 * sizeof(std::uint32_t);

template <class Number>
class PlyWriter : public MeshWriter {
 public:
  PlyWriter(const std::string& path, const MeshWriterOptions& options)
      : columns_(column_names(options)),
        integers_(options.integer_properties),
        types_(options.column_types),
        dimension_(options.dimension),
        header_bytes_(header(kMaxVertices, ~std::uint64_t{0}).size() + kMinPadding),
        file_(path, options, header_bytes_) {}

  void write(const MeshBatch& batch) override {
    write_vertices(batch);
    if (const std::uint64_t faces = face_count(batch); faces != 0) write_faces(batch, faces);
  }

  void close() override {
    std::string text = header(file_.vertex_count(), file_.face_count());
    // A comment fills the room that was reserved for longer counts.
    const std::size_t end = text.size() - std::strlen("end_header\n");
    text.insert(end, "comment" + std::string(header_bytes_ - text.size() - 8, ' ') + "\n");
    file_.commit(text);
  }

 private:
  static constexpr std::size_t kMinPadding = std::size_t{8};  // "comment\n"

  // A mesh with two coordinates gets a third one; coordinates after the third are further columns. Other formats have
  // properties with blanks in their names, or with the name of a coordinate, with which the header would be damaged.
  static std::vector<std::string> column_names(const MeshWriterOptions& options) {
    std::vector<std::string> names = {"x", "y", "z"};
    for (unsigned k = 3; k < options.dimension; ++k) names.push_back(std::string("c").append(std::to_string(k)));
    for (std::string name : options.property_names) {
      std::ranges::replace_if(
          name, [](unsigned char c) { return c <= ' ' || c == 0x7f; }, '_');
      while (name.empty() || std::ranges::find(names, name) != names.end()) name += '_';
      names.push_back(std::move(name));
    }
    return names;
  }

  bool is_integer(const std::string& column) const {
    return std::find(integers_.begin(), integers_.end(), column) != integers_.end();
  }

  const char* type_name(std::size_t column) const {
    constexpr const char* kNames[] = {"char ", "uchar ", "short ",  "ushort ", "int ",
                                      "uint ", "int64 ", "uint64 ", "float ",  "double "};
    if (!types_.empty()) return kNames[static_cast<std::size_t>(types_[column])];
    return is_integer(columns_[column]) ? "int " : sizeof(Number) == 4 ? "float " : "double ";
  }

  std::string header(std::uint64_t vertices, std::uint64_t faces) const {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    text += "element vertex " + std::to_string(vertices) + "\n";
    for (std::size_t k = 0; k < columns_.size(); ++k)
      text += std::string("property ") + type_name(k) + columns_[k] + "\n";
    text += "element face " + std::to_string(faces) + "\n";
    const bool is_signed = vertices <= kMaxVertices / 2;  // the bytes are the same
    text += std::string("property list uchar ") + (is_signed ? "int" : "uint") + " vertex_indices\n";
    return text + "end_header\n";
  }

  void write_vertices(const MeshBatch& batch) {
    BufferedWriter& out = file_.vertices(batch.vertex_count);
    if (file_.vertex_count() > kMaxVertices)
      throw Error(ErrorKind::kBadInput, "PLY indices cannot name more than 4294967296 vertices",
                  "write a mesh of fewer vertices, or OBJ")
          .at(file_.path());
    std::vector<const double*> columns;
    for (unsigned k = 0; k < std::max(3u, dimension_); ++k)
      columns.push_back(k < dimension_ ? batch.coordinates[k].data() : nullptr);
    for (const auto& column : batch.properties) columns.push_back(column.data());
    if (!types_.empty()) return write_typed(columns, batch.vertex_count, out);
    // Integers come last.
    const std::size_t numbers = columns.size() - integers_.size();
    const std::size_t bytes = numbers * sizeof(Number) + integers_.size() * sizeof(std::int32_t);
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      char* record = out.reserve_record(bytes);
      for (std::size_t k = 0; k < numbers; ++k) {
        const Number number = columns[k] == nullptr ? Number{0} : narrow(columns[k][i]);
        std::memcpy(record, &number, sizeof(Number));
        record += sizeof(Number);
      }
      for (std::size_t k = numbers; k < columns.size(); ++k) {
        const auto number = static_cast<std::int32_t>(columns[k][i]);
        std::memcpy(record, &number, sizeof number);
        record += sizeof number;
      }
      out.commit_record(bytes);
    }
  }

  void write_typed(const std::vector<const double*>& columns, std::size_t count, BufferedWriter& out) const {
    std::size_t bytes = 0;
    for (const ScalarType type : types_) bytes += byte_size(type);
    for (std::size_t i = 0; i < count; ++i) {
      char* record = out.reserve_record(bytes);
      for (std::size_t k = 0; k < columns.size(); ++k)
        with_type(types_[k], [&](auto zero) {
          const double value = columns[k] == nullptr ? 0 : columns[k][i];
          const auto number = narrow<decltype(zero)>(std::is_integral_v<decltype(zero)> ? std::round(value) : value);
          std::memcpy(record, &number, sizeof number);
          record += sizeof number;
        });
      out.commit_record(bytes);
    }
  }

  template <class To = Number>
  To narrow(double value) const {
    const auto number = static_cast<To>(value);
    if constexpr (std::is_floating_point_v<To>)
      if (std::isfinite(value) && !std::isfinite(number)) throw_out_of_range(value);
    return number;
  }

  [[noreturn]] void throw_out_of_range(double value) const {
    std::string text = "the number ";
    append_double(text, value);
    throw Error(ErrorKind::kBadInput, text + " does not fit a float", "write double numbers, or OBJ").at(file_.path());
  }

  void write_faces(const MeshBatch& batch, std::uint64_t count) {
    BufferedWriter& out = file_.faces(count);
    for_each_face(batch, 3, [&out](std::span<const VertexId> corners) {
      char* record = out.reserve_record(kMaxFaceBytes);
      *record++ = static_cast<char>(corners.size());
      for (const VertexId v : corners) {
        const auto corner = static_cast<std::uint32_t>(v.value());
        std::memcpy(record, &corner, sizeof corner);
        record += sizeof corner;
      }
      out.commit_record(1 + corners.size() * sizeof(std::uint32_t));
    });
  }

  std::vector<std::string> columns_, integers_;
  std::vector<ScalarType> types_;  // of all columns, if the options have them
  unsigned dimension_;
  std::size_t header_bytes_;
  SectionedFile file_;
};

}  // namespace

std::unique_ptr<MeshWriter> create_ply(const std::string& path, const MeshWriterOptions& options) {
  if (options.float64) return std::make_unique<PlyWriter<double>>(path, options);
  return std::make_unique<PlyWriter<float>>(path, options);
}

}  // namespace reeb::io
