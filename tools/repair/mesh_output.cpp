#include "tools/repair/mesh_output.h"

#include <algorithm>
#include <array>
#include <span>

#include "io/file/file_name.h"
#include "io/formats/create_mesh.h"
#include "io/formats/open_input.h"
#include "io/ply/ply_header.h"

namespace reeb::tools {
namespace {

bool keeps_properties(const std::string& output) { return io::name_suffix(output) == ".ply"; }

bool is_ply(const MeshInfo& info) { return info.format.starts_with("PLY"); }

io::PlyHeader ply_header(const io::Input& input) {
  io::TextCursor text(input.open());
  return io::read_ply_header(text);
}

// The types of the columns of a PLY file: what it declares.
std::vector<io::ScalarType> ply_types(const io::Input& input, const std::vector<std::string>& properties) {
  const io::PlyHeader header = ply_header(input);
  std::vector<io::ScalarType> types;
  for (const std::size_t k : header.coordinate_properties()) types.push_back(header.vertices().properties[k].type);
  while (types.size() < 3) types.push_back(types.empty() ? io::ScalarType::kFloat32 : types[0]);
  for (const std::size_t k : header.find_properties(properties, input.path()))
    types.push_back(header.vertices().properties[k].type);
  // New vertices lie between others, also where coordinates are whole numbers.
  for (std::size_t k = 0; k < 3; ++k)
    if (!io::is_float(types[k])) types[k] = io::ScalarType::kFloat64;
  return types;
}

}  // namespace

std::unique_ptr<MeshReader> open_for_copy(const io::Input& input, const MeshSource& source, const std::string& output) {
  ReadOptions options;
  options.all_properties = keeps_properties(output);
  options.signed_zeros = true;
  options.names_losses = true;
  options.temp_folder = source.temp_folder;
  return io::open_mesh(input, input.open(), options, source.image, source.format);
}

bool has_float32_positions(const io::Input& input, const MeshInfo& info) {
  if (!is_ply(info)) return info.float32;
  const auto types = ply_types(input, {});
  return std::ranges::all_of(types, [](io::ScalarType type) { return type == io::ScalarType::kFloat32; });
}

std::vector<std::string> lost_properties(const io::Input& input, const MeshInfo& info, const std::string& output) {
  std::string vertices, faces;
  const auto add = [](std::string& list, const std::string& name) { list += (list.empty() ? "" : ", ") + name; };
  if (!keeps_properties(output))
    for (const std::string& name : info.property_names) add(vertices, name);
  if (is_ply(info)) {
    for (const io::PlyElement& element : ply_header(input).elements)
      for (std::size_t k = 0; k < element.properties.size(); ++k) {
        if (element.role == io::PlyRole::kVertices && element.properties[k].list_count)
          add(vertices, element.properties[k].name);
        if (element.role == io::PlyRole::kFaces && k != element.corners) add(faces, element.properties[k].name);
      }
  }
  std::vector<std::string> lines;
  if (!vertices.empty()) lines.push_back("properties of vertices are dropped: " + vertices);
  if (!faces.empty()) lines.push_back("properties of faces are dropped: " + faces);
  return lines;
}

std::unique_ptr<MeshWriter> create_like(const io::Input& input, const MeshReader& reader, const std::string& output,
                                        std::uint64_t vertices, const std::string& temp_folder, io::Existing existing) {
  const MeshInfo& info = reader.info();
  io::MeshWriterOptions options;
  options.dimension = info.dimension;
  options.float64 = !info.float32;
  options.signed_zeros = true;
  options.vertex_count = vertices;
  options.existing = existing;
  options.temp_folder = temp_folder;
  if (keeps_properties(output)) {
    options.property_names = info.property_names;
    if (is_ply(info)) options.column_types = ply_types(input, info.property_names);
  }
  return io::create_mesh(output, options);
}

void MeshDigest::add(const MeshBatch& batch) {
  static constexpr std::array<double, 1024> kZeros{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (k < batch.coordinates.size()) {
      parts_[k].add(std::as_bytes(std::span(batch.coordinates[k]).first(batch.vertex_count)));
      continue;
    }
    for (std::size_t left = batch.vertex_count; left != 0; left -= std::min(left, kZeros.size()))
      parts_[k].add(std::as_bytes(std::span(kZeros).first(std::min(left, kZeros.size()))));
  }
  parts_[3].add(std::as_bytes(std::span(batch.triangles())));
}

std::array<std::uint64_t, 4> MeshDigest::value() const {
  return {parts_[0].value(), parts_[1].value(), parts_[2].value(), parts_[3].value()};
}

}  // namespace reeb::tools
