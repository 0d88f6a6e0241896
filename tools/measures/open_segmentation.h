// The segmentation of a mesh by a level of a .reeb file, as commands ask for it.
#pragma once

#include <cstdint>

#include "io/formats/open_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/run/compute.h"
#include "tools/library/run_files.h"

namespace reeb::tools {

// The file of values as an input, if the function of the graph has one.
// THROWS: Error{kBadInput} if the file names no function.
void add_values_of(const ooc::ReebFile& file, RunFiles& files);

// The mesh and the .reeb file as inputs, and the file of values if the function has one.
// THROWS: Error{kBadInput} if the mesh is a Reeb graph; as add_values_of() and RunFiles::add_mesh().
void add_segmentation_inputs(const std::string& mesh, const std::string& format, const io::ImageOptions& image,
                             const ooc::ReebFile& file, RunFiles& files);

// More than the index of any vertex: vertices of a grid that are left out have indices, too.
std::uint64_t vertex_bound(const ooc::ReebFile& file, const MeshInfo& info);

// How to run, without progress.
ooc::ComputeOptions segmentation_run(unsigned threads, const std::string& temp_folder);

}  // namespace reeb::tools
