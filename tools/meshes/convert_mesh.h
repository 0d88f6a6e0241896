// Converts a mesh of any format to any other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_spec.h"
#include "libreeb/base/memory_budget.h"
#include "tools/program/progress.h"

namespace reeb::tools {

struct TriangleOrder {
  enum class Kind { kKeep, kHilbert, kSpectral, kSweep };
  Kind kind = Kind::kKeep;
  std::optional<io::FunctionSpec> function;  // the function of a sweep
};

// "keep", "hilbert", "spectral", "sweep:FUNC". THROWS: Error{kUsage}.
TriangleOrder parse_order(const std::string& text);

struct ConvertOptions {
  std::string input, output;  // "-": standard input
  std::string format;         // of the input, as in open_mesh()
  TriangleOrder order;
  bool finalize = false;
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  std::string temp_folder;
  io::ImageOptions image = {};
  io::Existing existing = io::Existing::kRefuse;
};

// Converts in one of three ways, the first that fits:
// - between streaming formats, and into lists of events: the events of the file one by one, with the finalization, the
//   post-order and the values that they have;
// - with another order or --finalize, and into SMC if the input has no finalization: as a compact stream
//   (compact_stream.h) of the mesh, which is spooled to disk if necessary;
// - else batch by batch, as the reader delivers them.
// Returns notes, one line each, on what was odd or could not be kept.
// THROWS: Error; then no output appears.
std::vector<std::string> convert_mesh(const ConvertOptions& options, ProgressBar& bar);

}  // namespace reeb::tools
