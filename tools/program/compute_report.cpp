#include "tools/program/compute_report.h"

#include <fmt/core.h>

#include <array>
#include <nlohmann/json.hpp>

#include "libreeb/base/memory_budget.h"
#include "tools/program/progress.h"

namespace reeb::tools {
namespace {

const char* type_name(PairType type) {
  static constexpr std::array<const char*, 4> kNames = {"Ext0", "Ext1", "Ord0", "Rel1"};
  return kNames[static_cast<std::size_t>(type)];
}

const char* feature_name(PairType type) {
  switch (type) {
    case PairType::kExt1:
      return "loop";
    case PairType::kOrd0:
      return "minimum";
    case PairType::kRel1:
      return "maximum";
    case PairType::kExt0:
      break;
  }
  return "component";
}

void print_features(const ooc::ComputeResult& r) {
  const double range = r.range.max - r.range.min;
  if (!r.largest.empty()) fmt::print(stderr, "  largest features:\n");
  for (const ooc::Feature& f : r.largest) {
    const double persistence = f.hi.value - f.lo.value;
    fmt::print(stderr, "    {:<8} {:>12.6g}  ({:5.2f} %)  from {:.6g} (vertex {}) to {:.6g} (vertex {})\n",
               feature_name(f.type), persistence, range > 0 ? 100 * persistence / range : 0, f.lo.value,
               f.lo.vertex.value(), f.hi.value, f.hi.vertex.value());
  }
}

nlohmann::ordered_json to_json(const RunFacts& facts, const ooc::ComputeResult& r) {
  nlohmann::ordered_json pairs;
  for (const PairType type : {PairType::kOrd0, PairType::kRel1, PairType::kExt0, PairType::kExt1})
    pairs[type_name(type)] = r.pairs[static_cast<std::size_t>(type)];
  return {
      {"schema", "reeb.report.v1"},
      {"input",
       {{"path", facts.path},
        {"format", facts.format},
        {"vertices", r.vertices},
        {"triangles", r.triangles},
        {"bytes", facts.input_bytes}}},
      {"function", {{"name", r.function}, {"min", r.range.min}, {"max", r.range.max}}},
      {"graph", {{"nodes", r.nodes}, {"arcs", r.arcs}, {"components", r.betti.components}, {"loops", r.betti.loops}}},
      {"pairs", pairs},
      {"denoised_pairs", r.denoised_pairs},
      {"kept_loops", r.kept_loops},
      {"seconds",
       {{"wall", r.seconds.wall},
        {"finalization", r.seconds.finalization},
        {"reorder", r.seconds.reorder},
        {"reeb", r.seconds.reeb},
        {"hierarchy", r.seconds.hierarchy}}},
      {"peak_rss_bytes", peak_rss_bytes()},
      {"memory_budget_bytes", facts.memory_budget_bytes},
      {"spilled_bytes", r.spilled_bytes},
      {"live_max", {{"vertices", r.live.vertices}, {"edges", r.live.edges}, {"arcs", r.live.arcs}}},
      {"threads", facts.threads},
      {"reordered", r.reordered},
      {"guessed_vertices", r.guessed_vertices},
      {"revoked_guesses", r.revoked_guesses},
      {"output", r.output},
  };
}

}  // namespace

void print_summary(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results) {
  const ooc::ComputeResult& first = results.front();
  for (const std::string& note : first.notes) fmt::print(stderr, "note: {}\n", note);
  if (first.degenerate_triangles != 0)
    fmt::print(stderr, "note: {} degenerate triangles count as edges or vertices\n", first.degenerate_triangles);
  if (first.unused_vertices != 0)
    fmt::print(stderr, "note: {} vertices are in no triangle and count as isolated points\n", first.unused_vertices);
  for (const ooc::ComputeResult& r : results) {
    fmt::print(stderr, "Reeb graph of {} for f = {}  (from {:.6g} to {:.6g})\n", facts.path, r.function,
               r.vertices == 0 ? 0 : r.range.min, r.vertices == 0 ? 0 : r.range.max);
    fmt::print(stderr, "  {} nodes, {} arcs, {} components, {} loops\n", r.nodes, r.arcs, r.betti.components,
               r.betti.loops);
    if (r.denoised_pairs != 0) fmt::print(stderr, "  {} pairs of noise were removed\n", r.denoised_pairs);
    print_features(r);
    if (r.kept_loops != 0)
      fmt::print(stderr, "  {} of the loops cannot be cancelled exactly; they stay in every level\n", r.kept_loops);
    const double seconds = r.seconds.wall;
    fmt::print(stderr, "  {:.2f} s ({:.1f} M triangles/s), peak memory {}\n", seconds,
               seconds > 0 ? static_cast<double>(r.triangles) / seconds / 1e6 : 0, format_bytes(peak_rss_bytes()));
    fmt::print(stderr, "  wrote {}\n", r.output);
  }
}

std::string report_json(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results) {
  if (results.size() == 1) return to_json(facts, results[0]).dump(2) + "\n";
  auto array = nlohmann::ordered_json::array();
  for (const ooc::ComputeResult& r : results) array.push_back(to_json(facts, r));
  return array.dump(2) + "\n";
}

}  // namespace reeb::tools
