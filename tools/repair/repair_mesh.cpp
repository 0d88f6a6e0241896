#include "tools/repair/repair_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "io/file/content_source.h"
#include "io/formats/open_input.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "tools/defects/surface_census.h"
#include "tools/repair/mesh_output.h"
#include "tools/repair/repair_jobs.h"

namespace reeb::tools {
namespace {

class Plan {
 public:
  explicit Plan(const RepairOptions& options) : options_(options) {
    const io::Input input = io::mesh_input(options.mesh.path, options.mesh.format);
    const MeshInfo info = open_for_copy(input, options.mesh, options.output)->info();
    jobs_.float32 = has_float32_positions(input, info);
    jobs_.threads = options.threads;
    if (options.mesh.memory_bytes != MemoryBudget::kUnlimited)
      jobs_.patch_bytes = std::min(jobs_.patch_bytes, options.mesh.memory_bytes / 8);
    jobs_.progress = [this](std::uint64_t done, std::uint64_t total) {
      options_.mesh.check_interruption();
      if (options_.progress) options_.progress("repairing", done, total, 0);
    };
    repair_.warnings = lost_properties(input, info, options.output);
  }

  Repair run() {
    defects_ = find(options_.filter.named);
    prepare_rows();
    const ValuedMesh mesh(options_.mesh, {});
    ooc::Workspace space(options_.mesh.temp_folder, options_.mesh.memory_bytes);
    cleaning_ = plan_cleaning(mesh, options_.cleaning, space, jobs_.progress);
    mark_dropped();
    while (run_round(mesh, space)) {
    }
    finish_rows();
    if (repair_.mesh_triangles == 0) count(mesh);
    add_drops(mesh);
    return std::move(repair_);
  }

 private:
  void prepare_rows() {
    rows_ = choose_rows(defects_, options_.filter);
    failed_.assign(rows_.size(), 0);
    if (options_.filter.is_none()) repair_.suggestion = defects_.table.suggestion;
    for (const ChosenRow& row : rows_)
      repair_.rows.push_back(
          {row.rank, row.row->kind, row.row->length(), row.row->curve.inwards, false, row.why_not, 0, 0, 0});
  }

  void mark_dropped() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!rows_[i].why_not.empty() || !is_dropped(*rows_[i].row)) continue;
      failed_[i] = 1;
      repair_.rows[i].why = "component dropped";
    }
  }

  // Rows by their places, as many as --limit allows.
  std::vector<std::size_t> choose() const {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < rows_.size() && chosen.size() < options_.limit; ++i)
      if (rows_[i].why_not.empty() && failed_[i] == 0) chosen.push_back(i);
    return chosen;
  }

  // Repairs the chosen rows, and fills all boundaries. Returns whether to do it again: rows that cannot be repaired
  // make room for later ones.
  bool run_round(const ValuedMesh& mesh, ooc::Workspace& space) {
    std::vector<std::size_t> chosen = choose();
    const bool is_full = chosen.size() == options_.limit;
    for (std::size_t i = 0; i < cleaning_.boundaries.size(); ++i) chosen.push_back(rows_.size() + i);
    std::ranges::stable_sort(chosen, {}, [&](std::size_t i) {
      return i < rows_.size() ? rows_[i].row->length() : cleaning_.boundaries[i - rows_.size()].length;
    });
    const JobsDone done = run_jobs(mesh, jobs_of(chosen), defects_.scale, space, jobs_);
    for (RepairedRow& row : repair_.rows) row.done = false;
    repair_.boundaries_filled = 0;
    repair_.boundaries_left.assign(cleaning_.pinched_boundaries, "it is not one simple path");
    repair_.boundaries_left.insert(repair_.boundaries_left.end(), cleaning_.long_boundaries,
                                   "it is longer than --fill-boundaries LENGTH");
    bool has_failed = false;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const JobResult& result = done.results[k];
      if (chosen[k] >= rows_.size()) {
        repair_.boundaries_filled += result.done ? 1u : 0u;
        if (!result.done) repair_.boundaries_left.push_back(result.why);
        continue;
      }
      note(repair_.rows[chosen[k]], result);
      if (result.done) continue;
      failed_[chosen[k]] = 1;
      has_failed = true;
    }
    repair_.edits = done.edits;
    repair_.mesh_vertices = done.mesh_vertices;
    repair_.mesh_triangles = done.mesh_triangles;
    return has_failed && is_full;
  }

  void finish_rows() {
    for (RepairedRow& row : repair_.rows) {
      repair_.repaired += row.done ? 1u : 0u;
      if (!row.done && row.why.empty()) row.why = "beyond --limit";
    }
    if (repair_.repaired == 0) return;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (std::isinf(rows_[i].row->length()) || (failed_[i] != 0 && !is_dropped(*rows_[i].row)))
        repair_.second_may_help = true;
  }

  // All that are named in a file have a row.
  Defects find(const std::optional<NamedRows>& named) {
    FindDefectsOptions find;
    if (named) {
      const auto is_coordinate = [](const std::string& name) { return name == "x" || name == "y" || name == "z"; };
      if (!std::ranges::all_of(named->functions, is_coordinate)) find.functions = named->functions;
      for (const auto& [name, line] : named->lines) find.named.insert(name);
    }
    find.mesh = options_.mesh;
    find.threads = options_.threads;
    find.computing = [&](const ComputeProgress& p) {
      if (options_.progress) options_.progress("Reeb graphs", p.done, p.total, p.triangles);
    };
    find.searching = [&](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
      if (options_.progress) options_.progress("curves", done, total, triangles);
    };
    Defects defects = find_defects(find);
    if (!defects.note.empty()) repair_.warnings.push_back(defects.note);
    const auto& longest = options_.filter.limits.longest;
    if (longest && *longest > defects.scale.size && !defects.table.rows.empty())
      repair_.warnings.push_back(
          fmt::format("--longest {:.6g} is more than the whole mesh ({:.4g})", *longest, defects.scale.size));
    return defects;
  }

  bool is_dropped(const DefectRow& row) const {
    const std::uint64_t v = row.lo.key.vertex.value();
    return v < cleaning_.in_dropped.size() && cleaning_.in_dropped[v];
  }

  void add_drops(const ValuedMesh& mesh) {
    repair_.cleaning = options_.cleaning;
    repair_.degenerate = cleaning_.degenerate;
    repair_.duplicates = cleaning_.duplicates;
    repair_.components = cleaning_.components;
    repair_.component_triangles = cleaning_.component_triangles;
    repair_.isolated_vertices = cleaning_.isolated;
    repair_.seam_vertices = cleaning_.seam_vertices;
    if (cleaning_.removed.empty()) return;
    MeshEdits& edits = repair_.edits;
    if (edits.removed.empty())
      edits.removed = std::move(cleaning_.removed);
    else
      edits.removed.insert(edits.removed.end(), cleaning_.removed.begin(), cleaning_.removed.end());
    edits.sort();
    edits.dropped = unused_after(mesh, edits, jobs_.progress);
  }

  // Rows by their places, then boundaries.
  std::vector<RepairJob> jobs_of(std::span<const std::size_t> chosen) const {
    std::vector<RepairJob> jobs;
    for (const std::size_t i : chosen) {
      if (i >= rows_.size()) {
        jobs.push_back(cleaning_.boundaries[i - rows_.size()]);
        continue;
      }
      const DefectRow& row = *rows_[i].row;
      jobs.push_back({row.curve.path, row.length(), row.curve.place.box, false});
    }
    return jobs;
  }

  static void note(RepairedRow& row, const JobResult& result) {
    row.done = result.done;
    row.why = result.why;
    row.removed = result.removed;
    row.added = result.added;
    row.volume = row.inwards ? -result.volume : result.volume;
  }

  // Nothing is to be repaired, so the mesh was not read yet.
  void count(const ValuedMesh& mesh) {
    mesh.read(
        [&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
          repair_.mesh_vertices += batch.vertex_count;
          repair_.mesh_triangles += batch.triangle_count();
          jobs_.progress(done, total);
        });
  }

  const RepairOptions& options_;
  JobOptions jobs_;
  Defects defects_;
  std::vector<ChosenRow> rows_;       // of these defects
  std::vector<std::uint8_t> failed_;  // of each row, whether it cannot be repaired
  Cleaning cleaning_;
  Repair repair_;
};

std::size_t unclear_rows(const Repair& repair) {
  return static_cast<std::size_t>(std::ranges::count_if(
      repair.rows, [](const RepairedRow& row) { return !row.done && row.kind == DefectKind::kUnclear; }));
}

// What helps with rows of an unclear kind; empty: nothing does.
std::string note_on_unclear(const Repair& repair) {
  const std::size_t unclear = unclear_rows(repair);
  if (unclear == 0) return {};
  const std::string note =
      "note: the kind of " + (unclear == 1 ? "one loop" : count_of(unclear, "loop")) + " is unclear; ";
  // Seams must be joined first.
  const bool fill = repair.mesh_boundaries != 0 && repair.seam_vertices == 0 && !repair.cleaning.boundary_length;
  const bool drop = repair.mesh_duplicates != 0 && !repair.cleaning.duplicates;
  const std::string boundaries = count_of(repair.mesh_boundaries, "boundary"),
                    duplicates = count_of(repair.mesh_duplicates, "duplicate triangle");
  const std::string then = ", and a second repair, of the output, can help";
  if (fill && drop)
    return note + "the mesh has " + boundaries + " and " + duplicates +
           ": --fill-boundaries LENGTH, --drop-duplicates" + then;
  if (fill) return note + "the mesh has " + boundaries + ": --fill-boundaries LENGTH" + then;
  if (drop) return note + "the mesh has " + duplicates + ": --drop-duplicates" + then;
  return repair.boundaries_filled + repair.duplicates + repair.degenerate != 0 ? note + "repair the output again"
                                                                               : std::string();
}

// What repair cannot change, and where loops stay unclear.
std::vector<std::string> notes_on_obstacles(const Repair& repair) {
  std::vector<std::string> lines;
  const std::uint64_t edges = repair.nonmanifold_edges, vertices = repair.nonmanifold_vertices;
  // What is non-manifold at a degenerate triangle is not after it was dropped.
  if (edges + vertices != 0 && repair.degenerate == 0) {
    std::string places = edges != 0 ? count_of(edges, "non-manifold edge") : std::string();
    if (vertices != 0) places += (edges != 0 ? " and " : "") + count_of(vertices, "non-manifold vertex");
    lines.push_back("note: the mesh has " + places + ", which repair does not separate; a loop there stays unclear" +
                    (repair.mesh_degenerate == 0 ? ""
                                                 : "; --drop-degenerate can help (" +
                                                       count_of(repair.mesh_degenerate, "degenerate triangle") + ")"));
  }
  if (const std::uint64_t pinched = repair.pinched_boundaries; pinched != 0 && !repair.cleaning.boundary_length)
    lines.push_back("note: " + count_of(pinched, "boundary") + " of the mesh cannot be filled: " +
                    (pinched == 1 ? "it is not a simple path" : "they are not simple paths"));
  return lines;
}

void find_causes(const RepairOptions& options, Repair& repair) {
  const ooc::MeshCensus census = census_of(options.mesh);
  repair.mesh_duplicates = census.duplicates.count;
  repair.mesh_degenerate = census.degenerate.count;
  repair.nonmanifold_edges = census.nonmanifold_edges.count;
  repair.nonmanifold_vertices = census.nonmanifold_vertices.count;
  repair.mesh_boundaries = census.boundaries;
  if (census.boundaries == 0 || options.cleaning.boundary_length) return;
  ooc::Workspace space(options.mesh.temp_folder, options.mesh.memory_bytes);
  CleaningOptions all_boundaries;
  all_boundaries.boundary_length = std::numeric_limits<double>::infinity();
  const Cleaning cleaning = plan_cleaning(ValuedMesh(options.mesh, {}), all_boundaries, space,
                                          [&](std::uint64_t, std::uint64_t) { options.mesh.check_interruption(); });
  repair.mesh_boundaries = cleaning.boundaries.size();
  repair.pinched_boundaries = cleaning.pinched_boundaries;
  repair.seam_vertices = cleaning.seam_vertices;
}

}  // namespace

Repair plan_repair(const RepairOptions& options) {
  Repair repair = Plan(options).run();
  if (repair.repaired >= options.limit) repair.second_may_help = false;  // so would a greater limit
  try {
    if (unclear_rows(repair) != 0) find_causes(options, repair);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::kResource) throw;  // advice is no reason to fail where memory is scarce
  }
  return repair;
}

std::vector<std::string> summary_of(const Repair& repair) {
  std::vector<std::string> lines;
  if (repair.mesh_triangles == 0 && repair.rows.empty())
    lines.emplace_back("note: the mesh has no triangles");
  else
    lines.push_back(with_commas(repair.repaired) + " of " + count_of(repair.rows.size(), "loop") + " repaired");
  // A length of which it is not certain that it divides defects from features.
  constexpr double kUncertain = 0.6;
  if (repair.suggestion && repair.suggestion->length && repair.repaired != 0) {
    lines.push_back(fmt::format("as suggested, those with a curve of at most {:.4g} (confidence {:.0f} %)",
                                *repair.suggestion->length, 100 * repair.suggestion->confidence));
    if (repair.suggestion->confidence < kUncertain)
      lines.emplace_back(
          "note: it is not clear where defects end and features begin; look at `reeb defects MESH`, and keep features "
          "with --longest LENGTH or --loops FILE.csv");
  }
  std::map<std::string, std::size_t> reasons;
  for (const RepairedRow& row : repair.rows)
    if (!row.done) ++reasons[row.why];
  for (const auto& [why, count] : reasons) lines.push_back(with_commas(count) + " left: " + why);
  if (const std::string note = note_on_unclear(repair); !note.empty())
    lines.push_back(note);
  else if (repair.second_may_help)
    lines.emplace_back("note: a second repair, of the output, may find curves of loops that are left");
  for (std::string& note : notes_on_obstacles(repair)) lines.push_back(std::move(note));
  if (repair.cleaning.degenerate) lines.push_back(count_of(repair.degenerate, "degenerate triangle") + " dropped");
  if (repair.cleaning.duplicates) lines.push_back(count_of(repair.duplicates, "repeated triangle") + " dropped");
  if (repair.cleaning.components_percent)
    lines.push_back((repair.components == 0 ? "no component dropped"
                                            : count_of(repair.components, "component") + " of " +
                                                  count_of(repair.component_triangles, "triangle") + " dropped") +
                    (repair.isolated_vertices == 0 ? ""
                                                   : "; " + count_of(repair.isolated_vertices, "isolated vertex") +
                                                         (repair.isolated_vertices == 1 ? " stays" : " stay")));
  if (repair.cleaning.boundary_length) {
    lines.push_back(
        (repair.boundaries_filled == 1 ? "1 boundary" : with_commas(repair.boundaries_filled) + " boundaries") +
        " filled");
    reasons.clear();
    for (const std::string& why : repair.boundaries_left) ++reasons[why];
    for (const auto& [why, count] : reasons) lines.push_back(with_commas(count) + " not filled: " + why);
  }
  const bool fills_all = repair.cleaning.boundary_length && repair.boundaries_left.empty();
  if (repair.seam_vertices != 0 && !fills_all)
    lines.push_back("note: " + count_of(repair.seam_vertices, "vertex") +
                    " of boundaries have the coordinates of another one, but are not joined with it; join them first, "
                    "as docs/REPAIR.md shows");
  return lines;
}

}  // namespace reeb::tools
