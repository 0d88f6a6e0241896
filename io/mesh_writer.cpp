#include "io/mesh_writer.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "io/streaming/create_stream.h"
#include "io/writers/formats.h"
#include "libreeb/base/error.h"

namespace reeb::io {

std::string name_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

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

void copy_mesh(MeshReader& reader, MeshWriter& writer) {
  for (MeshBatch batch; reader.read(batch);) writer.write(batch);
  writer.close();
}

}  // namespace reeb::io
