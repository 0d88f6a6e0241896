// Opens a mesh whose file is open already, and says which files belong to a mesh.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/formats/open_mesh.h"
#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;
class Input;

// The file `path`, and what belongs to its mesh: of TetGen, the file of vertices beside it.
// THROWS: as open_content().
Input mesh_input(const std::string& path, const std::string& format = {});

// The other files that are read with the mesh or image `path`: the vertices of TetGen, and the data file that the
// header of an image names. None of a pipe, which is refused if it would need one.
// THROWS: as open_mesh(), for a file that cannot be opened and for the header of an image.
std::vector<std::string> files_beside(const std::string& path, const std::string& format, const ImageOptions& image);

// As open_mesh(path) for the content of `input`, which is open already, and with images as meshes of their division.
// THROWS: also Error{kUsage} for options of a raw file that are missing or wrong.
std::unique_ptr<MeshReader> open_mesh(const Input& input, std::unique_ptr<ContentSource> source,
                                      const ReadOptions& options, const ImageOptions& image,
                                      const std::string& format = {});

// Without images, for content that is open already; views of its beginning may have been taken. `path` decides between
// formats where the content cannot (format_detection.h).
std::unique_ptr<MeshReader> open_mesh(std::unique_ptr<ContentSource> source, const std::string& path,
                                      const ReadOptions& options = {}, const std::string& format = {});

}  // namespace reeb::io
