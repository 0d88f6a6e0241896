#include "tools/program/reeb_info.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {
namespace {

// The buckets of the full graph, which is the last line of the table.
std::uint64_t buckets_of_graph(const ooc::ReebFile& file) {
  return file.levels().empty() ? 0 : file.levels().back().buckets;
}

nlohmann::ordered_json to_json(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  nlohmann::ordered_json levels = nlohmann::ordered_json::array();
  for (const LevelLine& line : file.levels())
    levels.push_back({{"version", line.version},
                      {"threshold", line.threshold},
                      {"nodes", line.nodes},
                      {"arcs", line.arcs},
                      {"buckets", line.buckets},
                      {"file_bytes", line.file_bytes},
                      {"memory_bytes", line.memory_bytes}});
  nlohmann::ordered_json json = {
      {"schema", "reeb.info.v1"},
      {"path", file.path()},
      {"format", "reeb"},
      {"bytes", file.file_bytes()},
      {"whole", file.damage() == nullptr},
      {"function", {{"name", header.function}, {"min", header.function_min}, {"max", header.function_max}}},
      {"input", {{"vertices", header.mesh_vertices}, {"triangles", header.mesh_triangles}}},
      {"graph",
       {{"nodes", header.nodes}, {"arcs", header.arcs}, {"components", header.components}, {"loops", header.loops}}},
      {"graph_only", header.flags.graph_only},
      {"positions", header.flags.has_positions},
      {"embedding", header.flags.has_embedding ? nlohmann::ordered_json{{"bucket_exponent", header.bucket_exponent},
                                                                        {"buckets", buckets_of_graph(file)}}
                                               : nlohmann::ordered_json(nullptr)},
      {"cancellations", header.steps},
      {"pairs", header.pairs},
      {"kept_loops", header.kept_loops},
      {"denoise_threshold", header.denoise_threshold},
      {"denoised_pairs", header.denoised_pairs},
      {"content_digest", fmt::format("{:016x}", header.content_digest)}};
  json["levels"] = std::move(levels);
  return json;
}

// Thresholds are printed with all digits: used as input, they yield exactly their level.
void print_text(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  fmt::print("{}: Reeb graph, {}\n", file.path(), format_bytes(file.file_bytes()));
  fmt::print("  function   {} from {:.9g} to {:.9g}\n", header.function, header.function_min, header.function_max);
  fmt::print("  mesh       {} vertices, {} triangles\n", header.mesh_vertices, header.mesh_triangles);
  fmt::print("  graph      {} nodes, {} arcs, {} components, {} loops\n", header.nodes, header.arcs, header.components,
             header.loops);
  if (header.flags.has_embedding)
    fmt::print("  embedding  {} buckets, each {:.9g} of the function wide\n", buckets_of_graph(file),
               std::ldexp(1.0, header.bucket_exponent));
  if (header.denoise_threshold > 0 && header.denoised_pairs != 0)
    fmt::print("  denoised   {} pairs below {:.9g}\n", header.denoised_pairs, header.denoise_threshold);
  else if (header.denoised_pairs != 0)
    fmt::print("  denoised   {} pairs; others may be left\n", header.denoised_pairs);
  if (header.flags.graph_only)
    fmt::print("  hierarchy  none (the graph only)\n");
  else
    fmt::print("  hierarchy  {} pairs, {} cancellations, {} loops kept\n", header.pairs, header.steps,
               header.kept_loops);
  fmt::print("\n  {:>22} {:>12} {:>12} {:>12} {:>12}\n", "threshold", "nodes", "arcs", "of the file", "in memory");
  for (const LevelLine& line : file.levels())
    fmt::print("  {:>22} {:>12} {:>12} {:>12} {:>12}\n", line.threshold, line.nodes, line.arcs,
               format_bytes(line.file_bytes), format_bytes(line.memory_bytes));
}

}  // namespace

void print_reeb_info(const std::string& path, bool json) {
  const ooc::ReebFile file(path);
  if (const Error* damage = file.damage()) fmt::print(stderr, "reeb: warning: {}\n", damage->what());
  if (!json) return print_text(file);
  // Names can contain any bytes. Bytes that are not UTF-8 become replacement characters.
  fmt::print("{}\n", to_json(file).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace reeb::tools
