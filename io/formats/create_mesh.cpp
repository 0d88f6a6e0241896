#include "io/formats/create_mesh.h"

#include "io/file/file_name.h"
#include "io/formats/obj_writer.h"
#include "io/formats/off_writer.h"
#include "io/formats/ply_writer.h"
#include "io/streaming/create_stream.h"
#include "libreeb/base/error.h"

namespace reeb::io {

std::unique_ptr<MeshWriter> create_mesh(const std::string& path, const MeshWriterOptions& options) {
  if (stream_format(path) != StreamFormat::kNone) return create_stream_mesh(path, options);
  const std::string suffix = name_suffix(path);
  if (suffix == ".ply") return create_ply(path, options);
  if (suffix == ".obj") return create_obj(path, options);
  if (suffix == ".off") return create_off(path, options);
  throw Error(ErrorKind::kUsage, "cannot tell the mesh format to write from this name",
              "end the name of the output in .ply .obj .off .sma .smb .smc .sva .svb or .events.txt")
      .at(path);
}

}  // namespace reeb::io
