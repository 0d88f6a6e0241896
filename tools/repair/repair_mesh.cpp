#include "tools/repair/repair_mesh.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "io/file/content_source.h"
#include "io/formats/open_mesh.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
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
    const Defects defects = find(options_.filter.named);
    const std::vector<ChosenRow> rows = choose_rows(defects, options_.filter);
    if (options_.filter.is_none()) repair_.suggestion = defects.table.suggestion;
    for (const ChosenRow& row : rows)
      repair_.rows.push_back(
          {row.rank, row.row->kind, row.row->length(), row.row->curve.inwards, false, row.why_not, 0, 0, 0});
    const ValuedMesh mesh(options_.mesh, {});
    ooc::Workspace space(options_.mesh.temp_folder, options_.mesh.memory_bytes);
    const Cleaning cleaning = plan_cleaning(mesh, options_.cleaning, space, jobs_.progress);
    // Rows that cannot be repaired make room for later ones, so the choice may have to be made again.
    std::vector<std::uint8_t> failed(rows.size(), 0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!rows[i].why_not.empty() || !is_dropped(cleaning, *rows[i].row)) continue;
      failed[i] = 1;
      repair_.rows[i].why = "component dropped";
    }
    for (bool again = true; again;) {
      again = false;
      std::vector<std::size_t> chosen;
      for (std::size_t i = 0; i < rows.size() && chosen.size() < options_.limit; ++i)
        if (rows[i].why_not.empty() && failed[i] == 0) chosen.push_back(i);
      const std::size_t chosen_count = chosen.size();
      for (std::size_t i = 0; i < cleaning.boundaries.size(); ++i) chosen.push_back(rows.size() + i);
      const auto length = [&](std::size_t i) {
        return i < rows.size() ? rows[i].row->length() : cleaning.boundaries[i - rows.size()].length;
      };
      std::stable_sort(chosen.begin(), chosen.end(),
                       [&](std::size_t a, std::size_t b) { return length(a) < length(b); });
      const JobsDone done = run_jobs(mesh, jobs_of(rows, cleaning.boundaries, chosen), defects.scale, space, jobs_);
      for (RepairedRow& row : repair_.rows) row.done = false;
      repair_.boundaries_filled = 0;
      repair_.boundaries_left.assign(cleaning.pinched_boundaries, "it is not one simple path");
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        const JobResult& result = done.results[k];
        if (chosen[k] >= rows.size()) {
          repair_.boundaries_filled += result.done ? 1u : 0u;
          if (!result.done) repair_.boundaries_left.push_back(result.why);
          continue;
        }
        note(repair_.rows[chosen[k]], result);
        if (result.done) continue;
        failed[chosen[k]] = 1;
        again = again || chosen_count == options_.limit;
      }
      repair_.edits = done.edits;
      repair_.mesh_vertices = done.mesh_vertices;
      repair_.mesh_triangles = done.mesh_triangles;
    }
    for (std::size_t i = 0; i < repair_.rows.size(); ++i) {
      RepairedRow& row = repair_.rows[i];
      repair_.repaired += row.done ? 1u : 0u;
      if (!row.done && row.why.empty()) row.why = "beyond --limit";
    }
    for (std::size_t i = 0; i < rows.size() && repair_.repaired != 0; ++i)
      if (rows[i].row->curve.path.empty() || (failed[i] != 0 && !is_dropped(cleaning, *rows[i].row)))
        repair_.second_may_help = true;
    if (repair_.mesh_triangles == 0) count(mesh);
    add_drops(cleaning, mesh);
    return std::move(repair_);
  }

 private:
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
    return find_defects(find);
  }

  static bool is_dropped(const Cleaning& cleaning, const DefectRow& row) {
    const std::uint64_t v = row.lo.key.vertex.value();
    return v < cleaning.in_dropped.size() && cleaning.in_dropped[v];
  }

  void add_drops(const Cleaning& cleaning, const ValuedMesh& mesh) {
    repair_.cleaning = options_.cleaning;
    repair_.degenerate = cleaning.degenerate;
    repair_.duplicates = cleaning.duplicates;
    repair_.components = cleaning.components;
    repair_.component_triangles = cleaning.component_triangles;
    if (cleaning.removed.empty()) return;
    MeshEdits& edits = repair_.edits;
    edits.removed.insert(edits.removed.end(), cleaning.removed.begin(), cleaning.removed.end());
    edits.sort();
    edits.dropped = unused_after(mesh, edits, jobs_.progress);
  }

  // Rows by their places, then boundaries.
  static std::vector<RepairJob> jobs_of(const std::vector<ChosenRow>& rows, const std::vector<RepairJob>& boundaries,
                                        const std::vector<std::size_t>& chosen) {
    std::vector<RepairJob> jobs;
    for (const std::size_t i : chosen) {
      if (i >= rows.size()) {
        jobs.push_back(boundaries[i - rows.size()]);
        continue;
      }
      const DefectRow& row = *rows[i].row;
      jobs.push_back({row.curve.path, row.length(), row.curve.box, false});
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
  Repair repair_;
};

}  // namespace

Repair plan_repair(const RepairOptions& options) { return Plan(options).run(); }

std::vector<std::string> summary_of(const Repair& repair) {
  std::vector<std::string> lines = {with_commas(repair.repaired) + " of " + count_of(repair.rows.size(), "loop") +
                                    " repaired"};
  // A length of which it is not certain that it divides defects from features.
  constexpr double kUncertain = 0.6;
  if (repair.suggestion && repair.suggestion->length) {
    lines.push_back(fmt::format("as suggested, those with a curve of at most {:.4g} (confidence {:.0f} %)",
                                *repair.suggestion->length, 100 * repair.suggestion->confidence));
    if (repair.suggestion->confidence < kUncertain && repair.repaired != 0)
      lines.emplace_back(
          "note: some may be features: look at them with reeb defects, and choose with --longest or "
          "--loops");
  }
  std::map<std::string, std::size_t> reasons;
  for (const RepairedRow& row : repair.rows)
    if (!row.done) ++reasons[row.why];
  for (const auto& [why, count] : reasons) lines.push_back(with_commas(count) + " left: " + why);
  const auto unclear = static_cast<std::size_t>(std::ranges::count_if(
      repair.rows, [](const RepairedRow& row) { return !row.done && row.kind == DefectKind::kUnclear; }));
  if (unclear != 0 && !(repair.cleaning.duplicates && repair.cleaning.boundary_length))
    lines.push_back("note: the kind of " + with_commas(unclear) +
                    " is unclear; if the mesh has duplicate triangles or boundaries (see reeb info), "
                    "--drop-duplicates, --fill-boundaries LENGTH and a second repair can help");
  if (repair.second_may_help)
    lines.emplace_back("note: a second repair, of the output, may find curves of loops that are left");
  if (repair.cleaning.degenerate) lines.push_back(count_of(repair.degenerate, "degenerate triangle") + " dropped");
  if (repair.cleaning.duplicates) lines.push_back(count_of(repair.duplicates, "repeated triangle") + " dropped");
  if (repair.cleaning.components_percent)
    lines.push_back(count_of(repair.components, "component") + " of " +
                    count_of(repair.component_triangles, "triangle") + " dropped");
  if (!repair.cleaning.boundary_length) return lines;
  lines.push_back(
      (repair.boundaries_filled == 1 ? "1 boundary" : with_commas(repair.boundaries_filled) + " boundaries") +
      " filled");
  reasons.clear();
  for (const std::string& why : repair.boundaries_left) ++reasons[why];
  for (const auto& [why, count] : reasons) lines.push_back(with_commas(count) + " not filled: " + why);
  return lines;
}

}  // namespace reeb::tools
