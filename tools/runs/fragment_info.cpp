#include "tools/runs/fragment_info.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "libreeb/base/count_text.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/part_union.h"

namespace reeb::tools {
namespace {

nlohmann::ordered_json to_json(const ooc::FragmentFile& file, std::uint64_t open_vertices) {
  const ooc::PartInfo& info = file.info();
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const PartSpan& run : info.runs)
    for (std::uint32_t part = run.first; part <= run.last; ++part) parts.push_back(part + 1);
  const bool has_range = info.range.min <= info.range.max;
  return {{"schema", "reeb.fragment.v1"},
          {"path", file.path()},
          {"format", "fragment"},
          {"bytes", file.bytes()},
          {"parts", parts},
          {"of_parts", info.mesh.shares.parts},
          {"function",
           {{"name", info.function},
            {"min", has_range ? nlohmann::ordered_json(info.range.min) : nullptr},
            {"max", has_range ? nlohmann::ordered_json(info.range.max) : nullptr}}},
          {"input",
           {{"bytes", info.mesh.bytes},
            {"vertices", info.mesh.shares.vertices},
            {"triangles", info.mesh.shares.triangles}}},
          {"settled", {{"nodes", info.settled_nodes}, {"arcs", info.settled_arcs}}},
          {"open_vertices", open_vertices},
          {"graph_only", info.graph_only},
          {"buckets", info.buckets},
          {"denoise", info.denoise},
          {"denoise_is_share", info.denoise_is_share}};
}

void print_text(const ooc::FragmentFile& file, std::uint64_t open_vertices) {
  const ooc::PartInfo& info = file.info();
  const ooc::Shares& shares = info.mesh.shares;
  fmt::print("{}: fragment, {} of {}, {}\n", printable(file.path()), ooc::part_names(info.runs), shares.parts,
             format_bytes(file.bytes()));
  if (info.range.min <= info.range.max)
    fmt::print("  function   {} from {:.9g} to {:.9g}\n", printable(info.function), info.range.min, info.range.max);
  else
    fmt::print("  function   {}, no vertices\n", printable(info.function));
  fmt::print("  mesh       {}, {}, all parts together\n", count_of(shares.vertices, "vertex"),
             count_of(shares.triangles, "triangle"));
  fmt::print("  settled    {}, {}\n", count_of(info.settled_nodes, "node"), count_of(info.settled_arcs, "arc"));
  fmt::print("  open       {}, which other parts name\n", count_of(open_vertices, "vertex"));
  if (info.denoise > 0)
    fmt::print("  denoise    below {:.9g}{}\n", info.denoise_is_share ? 100 * info.denoise : info.denoise,
               info.denoise_is_share ? " % of the range, when it is glued" : "");
  if (info.graph_only)
    fmt::print("  made with  --graph-only\n");
  else if (info.buckets == 0)
    fmt::print("  made with  --buckets 0\n");
  else
    fmt::print("  embedding  about {} over the whole range\n", count_of(info.buckets, "bucket"));
}

}  // namespace

void print_fragment_info(const std::string& path, bool json) {
  ooc::FragmentFile file(path);
  const std::uint64_t open_vertices = open_vertices_of(file.read_open());
  if (!json) return print_text(file, open_vertices);
  fmt::print("{}\n", to_json(file, open_vertices).dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace reeb::tools
