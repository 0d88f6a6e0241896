// Opens a mesh of any supported format, which is detected from the content, or chosen.
//
// A reader keeps a batch in memory, not the mesh. STL is the exception: it keeps every vertex, to find equal corners
// (40 to 80 bytes each).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "libreeb/port/mesh_reader.h"

namespace reeb::io {

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

}  // namespace reeb::io
