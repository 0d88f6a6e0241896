#include "tools/measures/open_segmentation.h"

#include <algorithm>
#include <string>

#include "libreeb/base/error.h"
#include "tools/program/input_kind.h"

namespace reeb::tools {
namespace {

// THROWS: Error{kBadInput} if the file names no function.
io::FunctionSpec function_of(const ooc::ReebFile& file) {
  try {
    return io::parse_function(file.header().function);
  } catch (const Error& error) {
    throw Error(ErrorKind::kBadInput, "its function is unknown: " + error.message(), "compute the file again")
        .at(file.path());
  }
}

}  // namespace

void add_values_of(const ooc::ReebFile& file, RunFiles& files) { files.add_values_of(function_of(file)); }

void add_segmentation_inputs(const std::string& mesh, const std::string& format, const io::ImageOptions& image,
                             const ooc::ReebFile& file, RunFiles& files) {
  require_mesh_file(mesh, "name the mesh that it was computed from");
  files.add_mesh(mesh, format, image);
  files.add_input(file.path(), "the .reeb file");
  add_values_of(file, files);
}

std::uint64_t vertex_bound(const ooc::ReebFile& file, const MeshInfo& info) {
  const std::uint64_t vertices = file.header().mesh_vertices;
  return info.grid ? std::max(vertices, info.grid->vertex_count()) : vertices;
}

ooc::ComputeOptions segmentation_run(unsigned threads, const std::string& temp_folder) {
  ooc::ComputeOptions run;
  run.threads = threads;
  run.temp_dir = temp_folder;
  return run;
}

}  // namespace reeb::tools
