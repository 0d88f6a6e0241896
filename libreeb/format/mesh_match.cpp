#include "libreeb/format/mesh_match.h"

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb {
namespace {

void require_equal(const std::string& file, const char* what, std::uint64_t in_file, std::uint64_t in_mesh) {
  if (in_file == in_mesh) return;
  throw Error(ErrorKind::kBadInput,
              "this is not the graph of that mesh: it was computed from " + with_commas(in_file) + " " + what +
                  ", the mesh has " + with_commas(in_mesh),
              "name the mesh that the file was computed from; an image needs --nodata skip if that run had it")
      .at(file);
}

}  // namespace

void require_same_mesh(const std::string& file, const MeshCounts& in_file, const MeshCounts& in_mesh) {
  require_equal(file, "vertices", in_file.vertices, in_mesh.vertices);
  require_equal(file, "triangles", in_file.triangles, in_mesh.triangles);
}

}  // namespace reeb
