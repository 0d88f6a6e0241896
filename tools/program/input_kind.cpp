#include "tools/program/input_kind.h"

#include <filesystem>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/formats/foreign_format.h"
#include "io/formats/format_detection.h"
#include "io/formats/open_grid.h"
#include "libreeb/base/error.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {

std::string stem_of(const std::string& mesh) {
  if (mesh == "-") return "mesh";
  std::filesystem::path name = std::filesystem::path(mesh).filename();
  if (name.extension() == ".gz" || name.extension() == ".zst") name = name.stem();
  return name.stem().string();
}

void require_reeb_file(const std::string& path, const std::string& command) {
  if (path == "-")
    throw Error(ErrorKind::kUsage, "a Reeb graph cannot be read from standard input", "name a .reeb file");
  if (io::is_device(path))
    throw Error(ErrorKind::kUsage, "a Reeb graph cannot be read from a pipe or a device", "name a .reeb file").at(path);
  if (ooc::is_reeb_file(path)) return;
  if (ooc::is_fragment(path))
    throw Error(ErrorKind::kBadInput, "this is a fragment, not a Reeb graph",
                "`reeb glue` makes a Reeb graph of the fragments of all parts")
        .at(path);
  const auto source = io::open_content(path);
  const auto format = io::detect_format(*source, path);
  const auto image = io::detect_image(*source, path);
  if (format == io::MeshFormat::kUnknown && !image) {
    const std::string known(io::foreign_format(source->view(0)).name);
    throw Error(ErrorKind::kBadInput, "this is not a Reeb graph" + (known.empty() ? known : ", but " + known),
                "reeb MESH makes a Reeb graph, a .reeb file, from a mesh")
        .at(path);
  }
  const std::string graph = stem_of(path) + ".reeb";
  const std::string what =
      image ? std::string(io::image_name(*image)) : "a mesh (" + std::string(io::format_name(format)) + ")";
  throw Error(ErrorKind::kBadInput, "this is " + what + ", not a Reeb graph",
              "first `reeb " + path + "`, then `reeb " + command + " " + graph + "`")
      .at(path);
}

void require_mesh_file(const std::string& path, const std::string& hint) {
  if (path != "-" && ooc::is_reeb_file(path))
    throw Error(ErrorKind::kBadInput, "this is a Reeb graph, not a mesh", hint).at(path);
}

void require_mesh_to_reread(const std::string& path, const std::string& hint) {
  if (path == "-")
    throw Error(ErrorKind::kUsage, "the mesh is read several times, so it cannot come from standard input",
                "write it to a file first");
  require_mesh_file(path, hint);
}

}  // namespace reeb::tools
