// `reeb verify --full`: the graph of a mesh, computed again, against the one in a file.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "io/formats/open_mesh.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {

struct FullCheckOptions {
  std::string mesh, format, temp_folder;
  std::uint64_t memory_bytes = ~std::uint64_t{0};  // of the computation
  unsigned threads = 0;                            // 0: all
  io::ImageOptions image = {};
  std::function<bool()> interrupted = {};
};

// Computes the graph again, with the function and the noise threshold that the file names, and compares nodes, arcs and
// pairs.
// THROWS: Error{kBadInput} that names the first difference; what computing throws.
// MEMORY: that of the computation, then that of both graphs.
void check_fully(const ooc::ReebFile& file, const FullCheckOptions& options);

}  // namespace reeb::tools
