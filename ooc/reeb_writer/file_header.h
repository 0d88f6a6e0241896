// The header fields that come from the run, shared by the two writers.
#pragma once

#include <utility>

#include "ooc/reeb_writer/reeb_file_writer.h"

namespace reeb::ooc {

// Names longer than the format allows are cut.
inline FileHeader header_of(FileMeta meta) {
  FileHeader header;
  header.function = std::move(meta.function);
  if (header.function.size() > kMaxNameBytes) header.function.resize(kMaxNameBytes);
  header.function_min = meta.function_min;
  header.function_max = meta.function_max;
  header.mesh_vertices = meta.mesh_vertices;
  header.mesh_triangles = meta.mesh_triangles;
  header.denoise_threshold = meta.denoise_threshold;
  header.denoised_pairs = meta.denoised_pairs;
  header.bucket_exponent = meta.bucket_exponent;
  return header;
}

}  // namespace reeb::ooc
