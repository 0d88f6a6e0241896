// Meshes in files of VTK: legacy (.vtk: ASCII and binary, POLYDATA and UNSTRUCTURED_GRID, versions up to 5.1) and XML
// (.vtu and .vtp: arrays as text, in base64 or appended, plain or packed with zlib or lz4).
//
// Values at points are properties of vertices. Higher-order cells count with their corners; polyhedra are refused.
#pragma once

#include <memory>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// REQUIRES: content->reopen() is not null.
// THROWS: Error{kBadInput} as open_mesh.
std::unique_ptr<MeshReader> open_vtk_legacy(std::unique_ptr<ContentSource> content, const ReadOptions& options);
std::unique_ptr<MeshReader> open_vtk_xml(std::unique_ptr<ContentSource> content, const ReadOptions& options);

}  // namespace reeb::io
