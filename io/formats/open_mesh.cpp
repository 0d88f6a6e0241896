#include "io/formats/open_mesh.h"

#include "io/file/content_source.h"
#include "io/file/input_file.h"
#include "io/formats/open_input.h"

namespace reeb::io {

std::unique_ptr<MeshReader> open_mesh(const std::string& path, const ReadOptions& options, const std::string& format) {
  const Input input = mesh_input(path, format);
  return open_mesh(input, input.open(), options, {}, format);
}

}  // namespace reeb::io
