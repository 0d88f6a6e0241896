// What else can be cleaned in a surface: degenerate and repeated triangles, small components, small boundaries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ooc/whole_mesh/workspace.h"
#include "tools/defects/valued_mesh.h"
#include "tools/repair/mesh_edits.h"
#include "tools/repair/repair_jobs.h"

namespace reeb::tools {

struct CleaningOptions {
  bool degenerate = false, duplicates = false;
  std::optional<double> components_percent;  // fewer triangles than this share of the largest component
  std::optional<double> boundary_length;     // boundaries up to this length
  bool drops() const { return degenerate || duplicates || components_percent; }
  bool any() const { return drops() || boundary_length; }
};

struct Cleaning {
  std::vector<std::uint64_t> removed;  // triangles, ascending
  std::uint64_t degenerate = 0, duplicates = 0, components = 0, component_triangles = 0;
  std::vector<RepairJob> boundaries;   // to be closed
  std::size_t pinched_boundaries = 0;  // that are short enough, but no simple paths
  std::size_t long_boundaries = 0;     // the others, which are longer
  std::uint64_t seam_vertices = 0;     // of boundaries, where another one of them has the same position
  std::uint64_t isolated = 0;          // vertices that nothing uses, counted with components
  // Of a component that is dropped; empty: none is.
  std::vector<bool> in_dropped;
};

// Reads the mesh one to three times.
// MEMORY: sorting on disk for duplicates and boundaries, 8 bytes per vertex and 64 per component for components, up to
//         24 per triangle that is removed and up to 130 per edge of a boundary, from the budget. What is returned is
//         not charged any more.
// THROWS: Error{kResource} if the memory does not suffice.
Cleaning plan_cleaning(const ValuedMesh& mesh, const CleaningOptions& options, ooc::Workspace& space,
                       const std::function<void(std::uint64_t done, std::uint64_t total)>& progress);

// The vertices that something used before the edits, and nothing uses after them; ascending.
// MEMORY: 2 bits per vertex of the mesh.
std::vector<std::uint64_t> unused_after(const ValuedMesh& mesh, const MeshEdits& edits,
                                        const std::function<void(std::uint64_t done, std::uint64_t total)>& progress);

}  // namespace reeb::tools
