// From a mesh to what is to be changed in it: what `reeb repair` does, except for writing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/defects/valued_mesh.h"
#include "tools/repair/mesh_edits.h"
#include "tools/repair/row_choice.h"
#include "tools/repair/surface_cleaning.h"

namespace reeb::tools {

struct RepairOptions {
  MeshSource mesh;
  std::string output;  // its format decides what can be kept
  RowFilter filter;
  CleaningOptions cleaning;
  std::size_t limit = std::numeric_limits<std::size_t>::max();
  unsigned threads = 0;
  std::function<void(const char* pass, std::uint64_t done, std::uint64_t total, std::uint64_t triangles)> progress{};
};

struct RepairedRow {
  std::size_t rank = 0;
  DefectKind kind = DefectKind::kUnclear;
  double length = 0;
  bool inwards = false;  // the normals of its component are inside
  bool done = false;
  std::string why;  // it was not
  std::uint64_t removed = 0, added = 0;
  double volume = 0;  // that the solid gained: positive where a tunnel was filled
};

struct Repair {
  std::uint64_t mesh_vertices = 0, mesh_triangles = 0;
  MeshEdits edits;
  std::vector<RepairedRow> rows;  // by rank
  std::size_t repaired = 0;       // of them
  bool second_may_help =
      false;  // loops without a curve, or whose curve could not be cut, are left beside repaired ones
  std::optional<SuggestedLength> suggestion;                                              // if it decided
  CleaningOptions cleaning;                                                               // as asked for
  std::uint64_t degenerate = 0, duplicates = 0, components = 0, component_triangles = 0;  // that are dropped
  std::size_t boundaries_filled = 0;
  std::vector<std::string> boundaries_left;                // why
  std::uint64_t seam_vertices = 0, isolated_vertices = 0;  // as in Cleaning
  // Of the mesh, where loops of an unclear kind are left, which these can cause. Boundaries are those that can be
  // filled, if they are; pinched ones are no simple paths.
  std::uint64_t mesh_boundaries = 0, pinched_boundaries = 0, mesh_duplicates = 0, mesh_degenerate = 0;
  std::uint64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
  std::vector<std::string> warnings;
};

// THROWS: as find_defects(); Error{kBadInput} for a mesh of cells.
Repair plan_repair(const RepairOptions& options);

// What was done and what was left, in a few lines.
std::vector<std::string> summary_of(const Repair& repair);

}  // namespace reeb::tools
