#include "tools/program/input_kind.h"

#include <filesystem>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/formats/foreign_format.h"
#include "io/formats/format_detection.h"
#include "io/formats/open_grid.h"
#include "libreeb/base/error.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/names_file.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {
namespace {

// "a mesh (PLY)"; empty if it is neither that nor an image.
std::string mesh_or_image(io::ContentSource& source, const std::string& path) {
  if (const auto image = io::detect_image(source, path)) return std::string(io::image_name(*image));
  const auto format = io::detect_format(source, path);
  return format == io::MeshFormat::kUnknown ? "" : "a mesh (" + std::string(io::format_name(format)) + ")";
}

}  // namespace

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
  require_graph_file(path, "first `reeb " + path + "`, then `reeb " + command + " " + stem_of(path) + ".reeb`",
                     "reeb MESH makes a Reeb graph, a .reeb file, from a mesh");
}

void require_graph_file(const std::string& path, const std::string& hint_of_mesh, const std::string& hint) {
  if (ooc::is_reeb_file(path)) return;
  if (ooc::is_fragment(path))
    throw Error(ErrorKind::kBadInput, "this is a fragment, not a Reeb graph",
                "`reeb glue` makes a Reeb graph of the fragments of all parts")
        .at(path);
  const auto source = io::open_content(path);
  const std::string what = mesh_or_image(*source, path);
  if (what.empty()) {
    const std::string known(io::foreign_format(source->view(0)).name);
    if (known == "a Reeb graph")
      throw Error(ErrorKind::kBadInput, "the file ends within its header", "the file was cut; make it again").at(path);
    throw Error(ErrorKind::kBadInput, "this is not a Reeb graph" + (known.empty() ? known : ", but " + known), hint)
        .at(path);
  }
  throw Error(ErrorKind::kBadInput, "this is " + what + ", not a Reeb graph", hint_of_mesh).at(path);
}

void require_fragment(const std::string& path) {
  if (!io::is_regular_file(path) || ooc::is_fragment(path)) return;
  const auto refuse = [&](const std::string& what, const char* hint) {
    throw Error(ErrorKind::kBadInput, "this is " + what + ", not a fragment", hint).at(path);
  };
  if (ooc::is_reeb_file(path)) refuse("a Reeb graph", "name the fragments of its parts, and the output with -o");
  if (ooc::is_names_file(path)) refuse("a file of names", "give it to `reeb fragment --shared`");
  const auto source = io::open_content(path);
  if (const std::string what = mesh_or_image(*source, path); !what.empty())
    refuse(what, "`reeb fragment` makes fragments of it");
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
