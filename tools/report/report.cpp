#include "tools/report/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <ranges>
#include <utility>
#include <vector>

#include "io/text/number_text.h"
#include "io/text/xml_text.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "ooc/reeb_file/largest_pairs.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/checks/node_places.h"
#include "tools/defects/surface_census.h"
#include "tools/program/whole_levels.h"
#include "tools/report/closeups.h"
#include "tools/report/page_template.h"
#include "tools/report/page_text.h"
#include "tools/report/skeleton.h"
#include "tools/report/tables.h"

namespace reeb::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostPairs = 2000;  // in the diagram
constexpr std::size_t kMostRows = 500;    // of a table
constexpr std::size_t kMostSteps = 1000;  // of the curve of loops

// What was found before anything is written.
struct Findings {
  std::optional<ooc::LargestPairs> pairs;
  const char* no_pairs = "The file has no pairs";  // why, without pairs
  std::optional<std::uint32_t> finest;             // the finest level in the page
  Json skeleton;                                   // null if there is none
  std::optional<ooc::MeshCensus> census;
  std::optional<Defects> defects;
  Json closeups = Json::array();
  std::vector<std::string> notes;  // what is odd, wrong or missing
};

std::string base_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

// The finest such level that a cut file has.
std::optional<std::uint32_t> finest_level_of_cut(const ooc::ReebFile& file, std::size_t nodes, Findings& findings) {
  const LevelLine* finest = nullptr;
  for (const LevelLine& level : file.levels())
    if (is_whole(file, level) && level.nodes <= nodes) finest = &level;
  if (finest == nullptr) {
    findings.notes.push_back(
        fmt::format("There is no skeleton in this page: no level of at most {} is whole.", count_of(nodes, "node")));
    return std::nullopt;
  }
  findings.notes.push_back(fmt::format(
      "Finer levels are missing or have more than {}. The skeleton in this page shows those with at most {}.",
      count_of(nodes, "node"), with_commas(finest->nodes)));
  return finest->version;
}

// Without --nodes. A page with the most nodes has some 2 MB.
std::size_t usual_nodes(const FileHeader& header) {
  constexpr std::size_t kUsual = 2000, kMostOfCoarsest = 10'000;
  const std::size_t coarsest = header.levels.empty() ? 0 : header.levels.front().nodes;
  return coarsest > kUsual && coarsest <= kMostOfCoarsest ? coarsest + kUsual : kUsual;
}

// The finest level with few enough nodes; none if even the coarsest has more.
std::optional<std::uint32_t> finest_level(const ooc::ReebFile& file, const ReportOptions& options, Findings& findings) {
  const FileHeader& header = file.header();
  const std::size_t nodes = options.nodes.value_or(usual_nodes(header));
  const bool is_cut = !header.levels.empty() && !is_whole(file, header.levels.back());
  if (is_cut) return finest_level_of_cut(file, nodes, findings);
  if (header.nodes <= nodes) return 0;
  if (!header.flags.graph_only && header.levels.front().nodes <= nodes) {
    const std::uint32_t finest = file.finest_with_nodes(nodes);
    findings.notes.push_back(fmt::format(
        "The full graph has {}. The skeleton in this page shows the levels with at most {}; --nodes N sets another "
        "limit.",
        count_of(header.nodes, "node"), with_commas(nodes)));
    return finest;
  }
  const bool is_graph = header.flags.graph_only;
  const std::uint64_t least = is_graph ? header.nodes : header.levels.front().nodes;
  findings.notes.push_back(
      fmt::format("There is no skeleton in this page: {} has {}, more than {}. --nodes N sets another limit.",
                  is_graph ? "the graph" : "even the coarsest level", count_of(least, "node"), with_commas(nodes)));
  if (options.note)
    options.note(
        fmt::format("no skeleton: the {} has {}", is_graph ? "graph" : "coarsest level", count_of(least, "node")) +
        (least <= kMostReportNodes ? fmt::format("; --nodes {} includes it", least) : ""));
  return std::nullopt;
}

void note_file(const ooc::ReebFile& file, Findings& findings) {
  const FileHeader& header = file.header();
  auto& notes = findings.notes;
  if (const Error* damage = file.damage())
    notes.push_back(std::string("The file is damaged: ") + damage->what() + ". Some of it may be missing here.");
  if (header.flags.graph_only)
    notes.push_back(
        "The file has the graph only (--graph-only): there are no pairs and no levels, so features and plots are "
        "missing here.");
  if (header.nodes > 0 && !header.flags.has_positions)
    notes.push_back("The file has no positions: the skeleton shows values only, and no shape.");
  else if (header.nodes > 0 && !header.flags.has_embedding)
    notes.push_back("The file has no embedding (--buckets 0): arcs are straight lines.");
  if (header.denoised_pairs > 0)
    notes.push_back(fmt::format(
        "Noise was removed when the graph was computed: {}{}.", count_of(header.denoised_pairs, "pair"),
        header.denoise_threshold > 0 ? " of less persistence than " + io::short_number(header.denoise_threshold)
                                     : std::string()));
  if (header.kept_loops > 0)
    notes.push_back(fmt::format("{} cannot be cancelled exactly, so all levels have {}.",
                                count_of(header.kept_loops, "loop"), header.kept_loops == 1 ? "it" : "them"));
  if (header.nodes == 0) notes.push_back("The graph is empty: the mesh has no vertices.");
}

void note_census(const ooc::MeshCensus& census, Findings& findings) {
  auto& notes = findings.notes;
  if (!census.not_a_surface.empty()) {
    notes.push_back("The mesh is not a surface, so only its components were counted: " + census.not_a_surface + ".");
    return;
  }
  const auto note = [&](std::uint64_t count, const char* noun) {
    if (count > 0) notes.push_back(fmt::format("The mesh has {}.", count_of(count, noun)));
  };
  note(census.boundaries, "boundary");
  note(census.nonmanifold_edges.count, "non-manifold edge");
  note(census.nonmanifold_vertices.count, "non-manifold vertex");
  note(census.degenerate.count, "degenerate triangle");
  note(census.duplicates.count, "duplicate triangle");
  note(census.folded.count, "folded edge");
  note(census.loose_edges, "loose edge");
  if (census.orientable && !*census.orientable)
    notes.emplace_back("The surface cannot be oriented.");
  else if (census.oriented && !*census.oriented)
    notes.emplace_back("The triangles are not oriented consistently, but they can be.");
}

// THROWS: Error{kBadInput} unless the counts in the file are those of the mesh, and the nodes of the level, if there is
// one, are in it.
void require_mesh_of(const ooc::ReebFile& file, std::optional<std::uint32_t> version, const MeshSource& source) {
  const ReebGraph graph = version ? file.load(*version).graph : ReebGraph();
  NodePlaces places(source.path, graph);
  const ValuedMesh mesh(source, {});
  mesh.read([&](const MeshBatch& batch, auto, std::uint64_t, std::uint64_t) { places.add(batch); });
  places.finish(file.path(), file.header());
}

void search_mesh(const ooc::ReebFile& file, const ReportOptions& options, Findings& findings) {
  if (options.counting) options.counting();
  require_mesh_of(file, findings.finest, options.defects.mesh);
  findings.census = census_of(options.defects.mesh);
  note_census(*findings.census, findings);
  if (!findings.census->not_a_surface.empty()) return;  // curves are on surfaces
  findings.defects = find_defects(options.defects);
  if (const std::string& note = findings.defects->note; !note.empty())
    findings.notes.push_back("In the mesh, " + note + ".");
  const ValuedMesh mesh(options.defects.mesh, findings.defects->functions);
  findings.closeups = closeups_json(mesh, *findings.defects);
}

// Whether it could be read. Of a damaged file, `what` is named if it could not.
template <class Read>
bool read_if_whole(const ooc::ReebFile& file, const ReportOptions& options, const char* what, Findings& findings,
                   const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const bool is_damaged = says_damage(error) && error.file() == file.path();
    if (file.damage() == nullptr && !is_damaged) throw;
    findings.notes.push_back(fmt::format("{} cannot be read: {}.", what, error.what()));
    if (options.note && file.damage() == nullptr)
      options.note(fmt::format("{} cannot be read: {}", what, error.what()));
    return false;
  }
}

// With levels as fine as they are wanted and can be read.
void find_skeleton(const ooc::ReebFile& file, const ReportOptions& options, Findings& findings) {
  const bool is_whole = read_if_whole(file, options, "The finest level", findings, [&] {
    findings.finest = finest_level(file, options, findings);
    if (findings.finest) findings.skeleton = skeleton_json(file, *findings.finest);
  });
  if (is_whole) return;
  const std::size_t nodes = options.nodes.value_or(usual_nodes(file.header()));
  const std::uint32_t damaged = findings.finest.value_or(0);
  for (const LevelLine& level : file.levels() | std::views::reverse) {
    if (level.version <= damaged || level.nodes > nodes) continue;
    try {
      findings.skeleton = skeleton_json(file, level.version);
      findings.finest = level.version;
      findings.notes.push_back("The skeleton in this page shows the levels before the damage, with at most " +
                               count_of(level.nodes, "node") + ".");
      return;
    } catch (const Error& error) {  // a coarser one needs less of the file
      if (!says_damage(error)) throw;
    }
  }
  findings.finest.reset();
}

Findings find(const ooc::ReebFile& file, const ReportOptions& options) {
  Findings findings;
  note_file(file, findings);
  const FileHeader& header = file.header();
  if (!header.flags.graph_only) {
    findings.no_pairs = "The pairs cannot be read";
    read_if_whole(file, options, "The pairs", findings,
                  [&] { findings.pairs = ooc::read_largest_pairs(file.path(), kMostPairs); });
  }
  find_skeleton(file, options, findings);
  if (!options.defects.mesh.path.empty())
    search_mesh(file, options, findings);
  else
    findings.notes.emplace_back("The mesh was not checked (give it with --mesh).");
  return findings;
}

std::string range_text(double min, double max) {
  const int digits = io::digits_for_range(min, max, 9);
  return io::short_number(min, digits) + " to " + io::short_number(max, digits);
}

std::vector<NamedText> summary_rows(const ooc::ReebFile& file, const Findings& findings) {
  const FileHeader& header = file.header();
  std::vector<NamedText> rows{
      {"file", base_name(file.path())},
      {"function", header.function},
      {"range", range_text(header.function_min, header.function_max)},
      {"mesh vertices", with_commas(header.mesh_vertices)},
  };
  // Of images and tetrahedra, the file has no count.
  if (header.mesh_triangles != 0) rows.emplace_back("mesh triangles", with_commas(header.mesh_triangles));
  rows.insert(rows.end(), {{"nodes", with_commas(header.nodes)},
                           {"arcs", with_commas(header.arcs)},
                           {"components", with_commas(header.components)},
                           {"loops", with_commas(header.loops)}});
  if (findings.pairs) {
    const auto& counts = findings.pairs->counts;
    const auto count = [&](PairType type) { return with_commas(counts[static_cast<std::size_t>(type)]); };
    rows.insert(rows.end(), {{"minima (Ord0 pairs)", count(PairType::kOrd0)},
                             {"maxima (Rel1 pairs)", count(PairType::kRel1)},
                             {"components (Ext0 pairs)", count(PairType::kExt0)},
                             {"loops (Ext1 pairs)", count(PairType::kExt1)},
                             {"loops that stay at all levels", with_commas(header.kept_loops)}});
  }
  rows.emplace_back("pairs removed as noise", with_commas(header.denoised_pairs));
  rows.emplace_back("size of the file", format_bytes(file.file_bytes()));
  return rows;
}

std::vector<NamedText> census_rows(const std::string& mesh, const ooc::MeshCensus& census) {
  std::vector<NamedText> rows{{"mesh", base_name(mesh)}, {"connected components", with_commas(census.components)}};
  if (!census.not_a_surface.empty()) return rows;
  rows.insert(rows.end(),
              {{"boundaries", with_commas(census.boundaries)},
               {"non-manifold edges", with_commas(census.nonmanifold_edges.count)},
               {"non-manifold vertices", with_commas(census.nonmanifold_vertices.count)},
               {"degenerate triangles", with_commas(census.degenerate.count)},
               {"duplicate triangles", with_commas(census.duplicates.count)},
               {"folded edges", with_commas(census.folded.count)},
               {"Euler characteristic", fmt::format("{}{}", census.euler < 0 ? "-" : "",
                                                    with_commas(static_cast<std::uint64_t>(std::abs(census.euler))))},
               {"genus", census.genus ? with_commas(*census.genus) : "not defined: " + census.why_no_genus}});
  return rows;
}

std::string notes_list(const std::vector<std::string>& notes) {
  if (notes.empty()) return "<p class=\"fine\">Nothing unusual was found.</p>\n";
  std::string out = "<ul class=\"notes\">\n";
  for (const std::string& note : notes) out += "<li>" + io::xml_escaped(note) + "</li>\n";
  return out + "</ul>\n";
}

std::string features_section(const Findings& findings, const ValueRange& range) {
  if (!findings.pairs) return "<p>" + std::string(findings.no_pairs) + ", so there is no list of features.</p>\n";
  const auto& pairs = *findings.pairs;
  std::uint64_t all = 0;
  for (const std::uint64_t count : pairs.counts) all += count;
  if (all == 0) return "<p>There are no features.</p>\n";
  const auto rows = std::span(pairs.rows).first(std::min(pairs.rows.size(), kMostRows));
  std::string out = "<p>" + count_of(all, "pair");
  if (rows.size() < all)
    out += fmt::format("; the {} of largest persistence are listed, <code>reeb pairs</code> lists all",
                       with_commas(rows.size()));
  return out + ".</p>\n<div class=\"scroll\" role=\"region\" aria-label=\"Features\" tabindex=\"0\">\n" +
         pairs_table(rows, range, !findings.skeleton.is_null()) + "</div>\n";
}

std::string defects_section(const Findings& findings) {
  if (!findings.census)
    return "<p>Defects are placed and measured on the mesh: <code>reeb report FILE.reeb --mesh MESH -o "
           "OUT.html</code>.</p>\n";
  if (!findings.defects) return "<p>The mesh is not a surface, so it has no handles and tunnels to measure.</p>\n";
  const DefectTable& table = findings.defects->table;
  if (table.rows.empty()) return "<p>The surface has no loops, so it has no small handles or tunnels.</p>\n";
  const SuggestedLength& suggestion = table.suggestion;
  std::string out = "<p>" + count_of(table.rows.size(), "loop");
  const std::size_t listed = std::min(table.rows.size(), kMostRows);
  if (listed < table.rows.size())
    out += fmt::format("; the first {} are listed, <code>reeb defects</code> lists all", with_commas(listed));
  out += suggestion.length
             ? fmt::format(". Curves of at most {:.4g} are likely defects (confidence {:.0f} %): {}.",
                           *suggestion.length, 100 * suggestion.confidence, io::xml_escaped(suggestion.why))
             : fmt::format(". No length divides defects from features (confidence {:.0f} %): {}.",
                           100 * suggestion.confidence, io::xml_escaped(suggestion.why));
  return out + "</p>\n<div id=\"closeups\" class=\"closeups\"></div>\n" +
         "<div class=\"scroll\" role=\"region\" aria-label=\"Defects\" tabindex=\"0\">\n" +
         defects_table(*findings.defects, kMostRows, findings.closeups.size()) + "</div>\n";
}

// The number of loops at least as persistent as each of these, [persistence, number]; of many loops not all.
Json loop_steps(const std::vector<double>& loops) {
  Json steps = Json::array();
  double wanted = 1;
  const double factor = std::pow(static_cast<double>(std::max<std::size_t>(loops.size(), 1)), 1.0 / kMostSteps);
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (i + 1 < loops.size() && loops[i + 1] == loops[i]) continue;
    if (static_cast<double>(i + 1) < wanted && i + 1 < loops.size() && loops.size() > kMostSteps) continue;
    wanted = static_cast<double>(i + 1) * factor;
    steps.push_back({loops[i], i + 1});
  }
  return steps;
}

Json page_data(const ooc::ReebFile& file, Findings findings) {
  const FileHeader& header = file.header();
  Json data = {{"function", header.function}, {"min", header.function_min}, {"max", header.function_max}};
  Json pairs = Json::array();
  if (findings.pairs) {
    for (const ooc::PairRow& row : findings.pairs->rows)
      pairs.push_back({name_of(row.type), row.lo.key.value, row.hi.key.value, row.lo.key.vertex.value(),
                       row.hi.key.vertex.value(), row.lo.position, row.hi.position});
    data["loops"] = loop_steps(findings.pairs->loops);
    data["pair_count"] = header.pairs;
  } else {
    data["no_pairs"] = findings.no_pairs;
  }
  data["pairs"] = std::move(pairs);
  data["skeleton"] = std::move(findings.skeleton);
  data["closeups"] = std::move(findings.closeups);
  return data;
}

// Replaces each place `<!--reeb:NAME-->`.
std::string fill(std::string_view page, const std::vector<NamedText>& parts) {
  constexpr std::string_view kBegin = "<!--reeb:", kEnd = "-->";
  std::string out;
  for (;;) {
    const std::size_t at = page.find(kBegin);
    out += page.substr(0, at);
    if (at == std::string_view::npos) return out;
    page.remove_prefix(at + kBegin.size());
    const std::size_t end = page.find(kEnd);
    const auto part = std::ranges::find(parts, std::string(page.substr(0, end)), &NamedText::first);
    if (part != parts.end()) out += part->second;
    page.remove_prefix(end + kEnd.size());
  }
}

}  // namespace

void require_pages() {
  if (report_template().empty())
    throw Error(ErrorKind::kResource, "this program was built without pages",
                "build it with -DREEB_WEB=ON, which needs Node.js and npm (tools/install_packages.sh)");
}

std::string make_report(const ReportOptions& options) {
  const ooc::ReebFile file(options.file);
  const FileHeader& header = file.header();
  Findings findings = find(file, options);
  const ValueRange range{header.function_min, header.function_max};
  std::string summary = summary_table("Summary of the graph", summary_rows(file, findings));
  if (findings.census)
    summary += summary_table("Census of the mesh", census_rows(options.defects.mesh.path, *findings.census));
  const std::string name = base_name(options.file);
  std::vector<NamedText> parts{
      {"title", io::xml_escaped("Reeb graph report: " + name)},
      {"file", io::xml_escaped(name)},
      {"subtitle",
       io::xml_escaped(fmt::format("Reeb graph of {} on a mesh of {}", header.function,
                                   header.mesh_triangles == 0 ? count_of(header.mesh_vertices, "vertex")
                                                              : count_of(header.mesh_triangles, "triangle")))},
      {"summary", std::move(summary)},
      {"notes", notes_list(findings.notes)},
      {"features", features_section(findings, range)},
      {"defects", defects_section(findings)},
      {"levels", header.flags.graph_only ? "<p>The file has no levels.</p>\n"
                                         : "<div class=\"scroll\" role=\"region\" aria-label=\"Levels\" "
                                           "tabindex=\"0\">\n" +
                                               levels_table(file) + "</div>\n"},
  };
  parts.emplace_back("data", script_json(page_data(file, std::move(findings))));
  return fill(report_template(), parts);
}

}  // namespace reeb::tools
