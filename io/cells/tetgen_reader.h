// TetGen's X.ele and X.face (also Triangle's X.ele), with the vertices of X.node beside them.
//
// The first vertex has number 0 or 1. Attributes of vertices are the properties attribute:0, attribute:1, ...
#pragma once

#include <memory>
#include <string>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;

// Whether the name is that of such a file, packed or not.
bool is_tetgen_name(const std::string& path);

// X.node beside X.ele or X.face, packed or not; empty if there is none.
std::string tetgen_nodes(const std::string& path);

// `path` is that of `cells`, by which X.node is found, packed or not.
// REQUIRES: cells->reopen() is not null.
// THROWS: Error{kBadInput} as open_mesh: there is no X.node.
std::unique_ptr<MeshReader> open_tetgen(std::unique_ptr<ContentSource> cells, const std::string& path,
                                        const ReadOptions& options);

}  // namespace reeb::io
