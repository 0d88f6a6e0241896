#include "tools/program/compute_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/file/file.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "tools/program/progress.h"
#include "tools/program/quantity.h"
#include "tools/program/simplex_text.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

void print_features(const ooc::ComputeResult& r, const char* title, std::uint64_t all, bool loops) {
  const auto is_wanted = [&](const ooc::Feature& f) { return (f.type == PairType::kExt1) == loops; };
  const auto listed = static_cast<std::size_t>(std::ranges::count_if(r.largest, is_wanted));
  if (listed == 0) return;
  const bool some_are_zero = listed < ooc::kMostFeatures && listed < all;
  print_line(fmt::format("  {} ({}{} in all):", title, some_are_zero ? fmt::format("{} above zero, ", listed) : "",
                         with_commas(all)));
  for (const ooc::Feature& f : r.largest) {
    if (!is_wanted(f)) continue;
    const double persistence = f.hi.value - f.lo.value;
    print_line(fmt::format("    {:<7} {:>11.6g} {:>7.2f} %  vertex {} ({:.6g}) to {} ({:.6g})", feature_name(f.type),
                           persistence, percent_of(r.range, f.lo.value, f.hi.value), f.lo.vertex.value(), f.lo.value,
                           f.hi.vertex.value(), f.hi.value),
               35);
  }
}

bool has_cells(const ooc::ComputeResult& r) {
  return std::any_of(r.simplices.begin() + 3, r.simplices.end(), [](std::uint64_t count) { return count != 0; });
}

// Prints the text, and what another command says of the mesh (with its `graph`) if that can be read again. To be
// copied, the command is on one line.
void print_with_command(const RunFacts& facts, const std::string& text, const std::string& command,
                        const std::string& says, const std::string& graph = {}) {
  if (facts.fragments != 0 || facts.path == "-" || io::is_device(graph)) return print_line(text);
  const std::string more =
      fmt::format("`{} {}{}` {}", command, printable(facts.path), graph.empty() ? graph : " " + printable(graph), says);
  if (text.size() + 2 + more.size() <= kTextColumns) return print_line(text + "; " + more);
  print_line(text + ";");
  print_line("    " + more);
}

// The run counts no edges, which these need.
void print_not_checked(const RunFacts& facts, const ooc::ComputeResult& r) {
  if (has_cells(r) || facts.is_image || r.triangles() == 0) return;
  print_with_command(facts, "  surface not checked", "reeb info", "gives boundaries and genus");
}

void print_if_apart(const ooc::ComputeResult& r) {
  if (has_cells(r)) return;
  if (const std::string text = text_if_apart(r.triangles(), r.betti.components, r.arcs); !text.empty())
    print_line("  " + text);
}

// Only what `reeb defects` can measure.
void print_likely_defects(const RunFacts& facts, const ooc::ComputeResult& r) {
  if (r.likely_defects == 0 || has_cells(r)) return;
  const std::string text =
      fmt::format("  likely defects by persistence: {} of at most {:.2g} % of the range",
                  count_of(r.likely_defects, "loop"), percent_of(r.range, 0, r.likely_defects_up_to));
  print_with_command(facts, text, "reeb defects", "measures them", r.output);
}

// Of the triangles; of all simplices, if there are others.
std::string rate(const ooc::ComputeResult& r) {
  const std::uint64_t all = std::accumulate(r.simplices.begin(), r.simplices.end(), std::uint64_t{0});
  return fmt::format("{:.1f} M {}/s", r.seconds.wall > 0 ? static_cast<double>(all) / r.seconds.wall / 1e6 : 0,
                     all == r.triangles() ? "triangles" : "simplices");
}

void print_result(const RunFacts& facts, const ooc::ComputeResult& r) {
  const std::string what = facts.fragments == 0 ? printable(facts.path) : count_of(facts.fragments, "fragment");
  print_line(fmt::format("Reeb graph of {} for f = {} (from {:.6g} to {:.6g})", what, printable(r.function),
                         r.vertices == 0 ? 0 : r.range.min, r.vertices == 0 ? 0 : r.range.max));
  print_line(fmt::format("  mesh: {}, {}", count_of(r.vertices, "vertex"), count_simplices(r.simplices)));
  print_not_checked(facts, r);
  print_line(fmt::format("  graph: {}, {}, {}, {}", count_of(r.nodes, "node"), count_of(r.arcs, "arc"),
                         count_of(r.betti.components, "component"), count_of(r.betti.loops, "loop")));
  print_if_apart(r);
  if (r.denoised_pairs != 0) print_line("  removed as noise: " + count_of(r.denoised_pairs, "pair"));
  const auto pairs = [&](PairType type) { return r.pairs[static_cast<std::size_t>(type)]; };
  const std::uint64_t loops = pairs(PairType::kExt1), others = pairs(PairType::kOrd0) + pairs(PairType::kRel1);
  print_features(r, "largest loops", loops, true);
  print_likely_defects(facts, r);
  print_features(r, "largest minima and maxima", others, false);
  if (r.kept_loops != 0)
    print_line(fmt::format("  {} of the loops cannot be cancelled exactly; {} in every simplified level",
                           with_commas(r.kept_loops), r.kept_loops == 1 ? "it stays" : "they stay"));
  const double seconds = r.seconds.wall;
  print_line(fmt::format("  {:.2f} s ({}), peak memory {}", seconds, rate(r), format_bytes(peak_rss_bytes())));
  print_line("  wrote " + (r.output == io::kStandardOutput ? "to standard output" : printable(r.output)));
}

nlohmann::ordered_json to_json(const RunFacts& facts, const ooc::ComputeResult& r) {
  nlohmann::ordered_json pairs;
  for (const PairType type : {PairType::kOrd0, PairType::kRel1, PairType::kExt0, PairType::kExt1})
    pairs[name_of(type)] = r.pairs[static_cast<std::size_t>(type)];
  return {
      {"schema", "reeb.report.v1"},
      {"input",
       {{"path", facts.path},
        {"format", facts.format},
        {"vertices", r.vertices},
        {"triangles", r.triangles()},
        {"bytes", facts.input_bytes},
        {"simplices", r.simplices}}},
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
      {"live_max",
       {{"vertices", r.live.vertices}, {"edges", r.live.edges}, {"arcs", r.live.arcs}, {"bytes", r.live.bytes}}},
      {"threads", r.threads},
      {"reordered", r.reordered},
      {"guessed_vertices", r.guessed_vertices},
      {"revoked_guesses", r.revoked_guesses},
      {"output", r.output},
  };
}

}  // namespace

const char* feature_name(PairType type) {
  switch (type) {
    case PairType::kExt0:
      return "component";
    case PairType::kExt1:
      return "loop";
    case PairType::kOrd0:
      return "minimum";
    case PairType::kRel1:
      return "maximum";
  }
  return "";
}

void print_summary(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results) {
  const ooc::ComputeResult& first = results.front();
  for (const std::string& note : first.notes) print_line("note: " + printable(note));
  if (first.degenerate_triangles == 1)
    print_line("note: 1 face has fewer than three different corners and counts as an edge or a point");
  if (first.degenerate_triangles > 1)
    print_line("note: " + count_of(first.degenerate_triangles, "face") +
               " have fewer than three different corners and count as edges or points");
  if (first.unused_vertices == 1) print_line("note: 1 vertex is in no triangle and counts as an isolated point");
  if (first.unused_vertices > 1)
    print_line("note: " + count_of(first.unused_vertices, "vertex") +
               " are in no triangle and count as isolated points");
  for (const ooc::ComputeResult& r : results) print_result(facts, r);
}

std::string report_json(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results) {
  if (results.size() == 1)
    return to_json(facts, results[0]).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  auto array = nlohmann::ordered_json::array();
  for (const ooc::ComputeResult& r : results) array.push_back(to_json(facts, r));
  return array.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace reeb::tools
