#include "io/vtk/vtk_mesh_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/file_name.h"
#include "io/file/temp_dir.h"
#include "io/mesh/written_records.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kColumnBufferBytes = std::size_t{64} << 10;

class VtkMeshWriter : public MeshWriter {
 public:
  VtkMeshWriter(const std::string& path, const MeshWriterOptions& options, bool is_grid)
      : options_(options),
        is_grid_(is_grid),
        file_(path, {.existing = options.existing, .overwrites = true, .temp_folder = options.temp_folder}) {
    const TempDir temp(options.temp_folder.empty() ? TempDir::default_folder(path) : options.temp_folder);
    for (std::size_t k = 0; k < options.property_names.size(); ++k)
      properties_.emplace_back(temp.create_unnamed("point data"), kColumnBufferBytes);
    for (std::size_t k = 0; k < most_corners(); ++k)
      cells_.emplace_back(temp.create_unnamed("cells"), kColumnBufferBytes);
    file_.out().append(head());
    file_.out().append("<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n");
  }

  void write(const MeshBatch& batch) override {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      TextRecord line(file_.out());
      for (std::size_t k = 0; k < 3; ++k) {
        line.put(k < batch.coordinates.size() ? batch.coordinates[k][i] : 0.0);
        line.put(k < 2 ? ' ' : '\n');
      }
    }
    for (std::size_t k = 0; k < properties_.size(); ++k)
      for (std::size_t i = 0; i < batch.vertex_count; ++i) {
        TextRecord line(properties_[k]);
        if (is_integer(k))
          line.put(static_cast<std::int64_t>(batch.properties[k][i]));
        else
          line.put(batch.properties[k][i]);
        line.put('\n');
      }
    vertices_ += batch.vertex_count;
    for_each_face(batch, most_corners(), [this](std::span<const VertexId> corners) {
      TextRecord line(cells_[corners.size() - 1]);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        line.put(corners[i].value());
        line.put(i + 1 < corners.size() ? ' ' : '\n');
      }
      ++counts_[corners.size() - 1];
    });
  }

  void close() override {
    BufferedWriter& out = file_.out();
    out.append("</DataArray>\n</Points>\n<PointData");
    if (!properties_.empty()) out.append(" Scalars=\"" + options_.property_names[0] + '"');
    out.append(">\n");
    for (std::size_t k = 0; k < properties_.size(); ++k) {
      begin_array(is_integer(k) ? "Int64" : "Float64", options_.property_names[k]);
      out.append_file(properties_[k]);
      end_array();
    }
    out.append("</PointData>\n");
    if (is_grid_)
      write_cells("Cells", 0, most_corners());
    else
      for (std::size_t k = 0; k < most_corners(); ++k) write_cells(kSections[k], k, k + 1);
    out.append(std::string("</Piece>\n</") + type() + ">\n</VTKFile>\n");
    out.overwrite(0, head());
    file_.commit();
  }

 private:
  static constexpr std::array<const char*, 3> kSections{"Verts", "Lines", "Polys"};
  static constexpr std::array<int, 4> kCellTypes{1, 3, 5, 10};  // vertex, line, triangle, tetrahedron

  std::size_t most_corners() const { return is_grid_ ? 4 : 3; }
  const char* type() const { return is_grid_ ? "UnstructuredGrid" : "PolyData"; }
  bool is_integer(std::size_t property) const {
    return std::ranges::count(options_.integer_properties, options_.property_names[property]) != 0;
  }

  // Always of the same length: spaces fill the room of longer counts.
  std::string head() const {
    constexpr std::size_t kBytes = 512;
    std::string text = std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"") + type() +
                       "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<" + type() +
                       ">\n<Piece NumberOfPoints=\"" + std::to_string(vertices_) + '"';
    if (is_grid_) {
      text += " NumberOfCells=\"" + std::to_string(counts_[0] + counts_[1] + counts_[2] + counts_[3]) + '"';
    } else {
      for (std::size_t k = 0; k < kSections.size(); ++k)
        text += std::string(" NumberOf") + kSections[k] + "=\"" + std::to_string(counts_[k]) + '"';
      text += " NumberOfStrips=\"0\"";
    }
    text.resize(kBytes - 2, ' ');
    return text + ">\n";
  }

  void begin_array(const char* number, const std::string& name) {
    file_.out().append(std::string("<DataArray type=\"") + number + "\" Name=\"" + name + "\" format=\"ascii\">\n");
  }
  void end_array() { file_.out().append("</DataArray>\n"); }

  // The cells of first + 1 to last corners.
  void write_cells(const char* section, std::size_t first, std::size_t last) {
    BufferedWriter& out = file_.out();
    out.append(std::string("<") + section + ">\n");
    begin_array("Int64", "connectivity");
    for (std::size_t k = first; k < last; ++k) out.append_file(cells_[k]);
    end_array();
    begin_array("Int64", "offsets");
    std::uint64_t offset = 0;
    for (std::size_t k = first; k < last; ++k)
      for (std::uint64_t i = 0; i < counts_[k]; ++i) put_line(offset += k + 1);
    end_array();
    if (is_grid_) {
      begin_array("UInt8", "types");
      for (std::size_t k = first; k < last; ++k)
        for (std::uint64_t i = 0; i < counts_[k]; ++i) put_line(kCellTypes[k]);
      end_array();
    }
    out.append(std::string("</") + section + ">\n");
  }

  void put_line(std::integral auto number) {
    TextRecord line(file_.out());
    line.put(number);
    line.put('\n');
  }

  const MeshWriterOptions options_;
  const bool is_grid_;
  AtomicFile file_;
  std::deque<BufferedWriter> properties_, cells_;  // by property; by corners - 1
  std::uint64_t vertices_ = 0;
  std::array<std::uint64_t, 4> counts_{};  // of cells, by corners - 1
};

}  // namespace

std::unique_ptr<MeshWriter> create_vtk_mesh(const std::string& path, const MeshWriterOptions& options) {
  const std::string suffix = name_suffix(path);
  if (suffix != ".vtu" && suffix != ".vtp")
    throw Error(ErrorKind::kUsage, '"' + suffix + "\" is not a suffix of a VTK mesh", "end the name in .vtu or .vtp")
        .at(path);
  return std::make_unique<VtkMeshWriter>(path, options, suffix == ".vtu");
}

}  // namespace reeb::io
