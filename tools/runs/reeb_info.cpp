#include "tools/runs/reeb_info.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "libreeb/base/count_text.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/program/quantity.h"
#include "tools/program/whole_levels.h"

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
                      {"memory_bytes", line.memory_bytes},
                      {"whole", is_whole(file, line)}});
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

void print_text(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  const ValueRange range{header.function_min, header.function_max};
  fmt::print("{}: Reeb graph, {}\n", printable(file.path()), format_bytes(file.file_bytes()));
  fmt::print("  function   {} from {:.9g} to {:.9g}\n", printable(header.function), header.function_min,
             header.function_max);
  fmt::print("  mesh       {}, {}\n", count_of(header.mesh_vertices, "vertex"),
             header.mesh_triangles == 0 ? "no triangles; the file has no count of other simplices"
                                        : count_of(header.mesh_triangles, "triangle"));
  fmt::print("  graph      {}, {}, {}, {}\n", count_of(header.nodes, "node"), count_of(header.arcs, "arc"),
             count_of(header.components, "component"), count_of(header.loops, "loop"));
  if (header.flags.has_embedding)
    fmt::print("  embedding  {} along the arcs, in buckets of width {:.9g}\n",
               count_of(buckets_of_graph(file), "point"), std::ldexp(1.0, header.bucket_exponent));
  if (header.denoised_pairs != 0)
    fmt::print(
        "  denoised   {}{}\n", count_of(header.denoised_pairs, "pair"),
        header.denoise_threshold > 0 ? fmt::format(" below {:.9g}", header.denoise_threshold) : "; others may be left");
  if (header.flags.graph_only)
    fmt::print("  hierarchy  none (the graph only)\n");
  else
    fmt::print("  hierarchy  {}, {}, {} that cannot be cancelled\n", count_of(header.pairs, "pair"),
               count_of(header.steps, "cancellation"), count_of(header.kept_loops, "loop"));
  std::vector<std::string> thresholds;
  std::size_t columns = 12;
  for (const LevelLine& line : file.levels()) {
    thresholds.push_back(threshold_text(file, line));
    columns = std::max(columns, thresholds.back().size());
  }
  fmt::print("\n  {:>{}} {:>9} {:>12} {:>12} {:>11} {:>11}\n", "threshold", columns, "of range", "nodes", "arcs",
             "bytes read", "memory");
  auto threshold = thresholds.begin();
  for (const LevelLine& line : file.levels())
    fmt::print("  {:>{}} {:>9} {:>12} {:>12} {:>11} {:>11}{}\n", *threshold++, columns,
               range.max > range.min ? fmt::format("{:.3g} %", percent_of(range, 0, line.threshold)) : "",
               with_commas(line.nodes), with_commas(line.arcs), format_bytes(line.file_bytes),
               format_bytes(line.memory_bytes), is_whole(file, line) ? "" : "  missing");
}

}  // namespace

void print_reeb_info(const std::string& path, bool json) {
  const ooc::ReebFile file(path);
  warn_of_damage(file);
  if (!json) return print_text(file);
  // Names can contain any bytes. Bytes that are not UTF-8 become replacement characters.
  fmt::print("{}\n", to_json(file).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace reeb::tools
