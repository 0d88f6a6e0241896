#include "io/formats/create_mesh.h"

#include "io/file/file.h"
#include "io/file/file_name.h"
#include "io/formats/cx_writer.h"
#include "io/formats/obj_writer.h"
#include "io/formats/off_writer.h"
#include "io/ply/ply_writer.h"
#include "io/streaming/create_stream.h"
#include "libreeb/base/error.h"

namespace reeb::io {

void check_mesh_name(const std::string& path) {
  const std::string suffix = name_suffix(path);
  if (stream_format(path) != StreamFormat::kNone || suffix == ".ply" || suffix == ".obj" || suffix == ".off" ||
      suffix == ".cx")
    return;
  if (path == kStandardOutput)
    throw Error(ErrorKind::kUsage, "a mesh is not written to standard output",
                "name a file, which ends in .ply .obj .off .cx .sma .smb .smc .sva .svb or .events.txt");
  throw Error(ErrorKind::kUsage,
              suffix == ".stl" ? "STL is read, but not written" : "cannot tell the mesh format to write from this name",
              "end the name of the output in .ply .obj .off .cx .sma .smb .smc .sva .svb or .events.txt")
      .at(path);
}

bool has_tetrahedra(const std::string& path) {
  return is_volume_name(path) || stream_format(path) == StreamFormat::kEvents || name_suffix(path) == ".cx";
}

std::unique_ptr<MeshWriter> create_mesh(const std::string& path, const MeshWriterOptions& options) {
  check_mesh_name(path);
  if (stream_format(path) != StreamFormat::kNone) return create_stream_mesh(path, options);
  const std::string suffix = name_suffix(path);
  if (suffix == ".ply") return create_ply(path, options);
  if (suffix == ".obj") return create_obj(path, options);
  if (suffix == ".cx") return create_cx(path, options);
  return create_off(path, options);
}

}  // namespace reeb::io
