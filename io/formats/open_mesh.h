// Opens a mesh of any supported format, which is detected from the content, or chosen.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

class ContentSource;
class Input;

// How to read images: regular grids of values, which are meshes by their division into simplices.
struct ImageOptions {
  // Of a file without a header, as the program's --grid, --type, --spacing and --skip.
  std::string grid{}, type{}, spacing{};
  std::uint64_t skip_bytes = 0;

  bool skip_nodata = false;  // leave out vertices without data, with all simplices that contain them
  bool renumber = false;     // and number the others 0, 1, 2, ...; otherwise they keep their indices in the grid

  bool is_raw() const { return !grid.empty() || !type.empty() || !spacing.empty() || skip_bytes != 0; }
};

// Opens `path` ("-": standard input), decompresses gzip and zstd, and reads the header. Uncompressed binary PLY with
// vertices of fixed size also has MeshReader::indexed(), which does not open the file again.
// `format`: "ply", "cx", ... where the content does not tell, and the name has no suffix that does; empty: detected.
// THROWS: Error{kUsage} for another format; Error{kBadInput} with file, position and a hint: unreadable, a directory,
//         empty, of an unknown format, a damaged header, a property that the mesh does not have.
// THREADS: any number of calls at the same time; "-" once.
std::unique_ptr<MeshReader> open_mesh(const std::string& path, const ReadOptions& options = {},
                                      const std::string& format = {});

// The file `path`, and what belongs to its mesh: of TetGen, the file of vertices beside it.
// THROWS: as open_content().
Input mesh_input(const std::string& path, const std::string& format = {});

// The other files that are read with the mesh or image `path`: the vertices of TetGen, and the data file that the
// header of an image names. None of a pipe, which is refused if it would need one.
// THROWS: as open_mesh(), for a file that cannot be opened and for the header of an image.
std::vector<std::string> files_beside(const std::string& path, const std::string& format, const ImageOptions& image);

// The same as the first for the content of `input`, which is open already, and with images as meshes of their division.
// THROWS: also Error{kUsage} for options of a raw file that are missing or wrong.
std::unique_ptr<MeshReader> open_mesh(const Input& input, std::unique_ptr<ContentSource> source,
                                      const ReadOptions& options, const ImageOptions& image,
                                      const std::string& format = {});

// Without images, for content that is open already; views of its beginning may have been taken. `path` decides between
// formats where the content cannot (format_detection.h).
std::unique_ptr<MeshReader> open_mesh(std::unique_ptr<ContentSource> source, const std::string& path,
                                      const ReadOptions& options = {}, const std::string& format = {});

}  // namespace reeb::io
