// What is wrong with a surface, counted exactly: boundaries, non-manifold places, degenerate, duplicate and folded
// triangles; and whether it has a genus (docs/SEMANTICS.md, Census of a surface).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/port/indexed_mesh.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::ooc {

struct CensusPlace {
  std::vector<VertexId> vertices;  // one, the two of an edge or the three of a triangle; ascending
  Point position{};                // the mean of theirs
};

// Of each kind of places those with the lowest vertices are listed. So the list depends on the mesh only, and not on
// the order of its triangles.
struct CensusCount {
  static constexpr std::size_t kMostPlaces = 10;

  std::uint64_t count = 0;
  std::vector<CensusPlace> places;
};

struct CensusComponent {
  std::uint64_t triangles = 0;  // without degenerate ones
  std::uint64_t vertices = 0;
  CensusPlace first;  // its lowest vertex
};

struct CensusBoundary {
  std::uint64_t edges = 0;
  double length = 0;
  Point min{}, max{};  // its box
  CensusPlace first;   // its lowest vertex
};

struct MeshCensus {
  std::uint64_t vertices = 0, unused_vertices = 0;
  SimplexCounts simplices{};                // as listed
  std::optional<std::uint64_t> live_front;  // vertices in use at once; nothing if triangles lie too far apart to tell
  std::uint64_t components = 0;             // isolated vertices included

  // Empty for a surface: then the mesh consists of triangles, edges and points. Else all that follows is empty, too.
  std::string not_a_surface;

  std::vector<CensusComponent> largest_components;  // most triangles first; at most kMostPlaces, as below
  std::uint64_t boundaries = 0;
  std::vector<CensusBoundary> longest_boundaries;
  CensusCount nonmanifold_edges, nonmanifold_vertices;
  CensusCount degenerate, duplicates;  // triangles
  CensusCount folded;                  // edges
  std::uint64_t loose_edges = 0;       // of no triangle
  std::int64_t euler = 0;              // vertices - edges + triangles, of distinct ones with distinct corners
  bool closed = false;                 // there are triangles, no edge has just one, and no edge is loose
  // Whether the triangles can be turned so that neighbours agree; and whether they agree as they are. Nothing if an
  // edge has more than two triangles.
  std::optional<bool> orientable, oriented;
  std::optional<std::uint64_t> genus;  // the sum over the components, with holes closed
  std::string why_no_genus;            // "it has 3 non-manifold edges"; empty if there is a genus
};

struct CensusProgress {
  enum class Phase { kSpool, kFront, kSort, kCount };
  Phase phase;
  std::uint64_t done = 0, total = 0;  // in one unit; total 0: unknown
  std::uint64_t simplices = 0;        // so far
};

struct CensusOptions {
  bool background = false;          // one thread reads while another counts
  std::size_t chunk_triangles = 0;  // that are read at a time; 0: as suits the memory
  std::function<void(const CensusProgress&)> progress = {};
  // Sees every batch that a reader delivers, once.
  std::function<void(const MeshBatch&)> observe = {};
  // The mesh from its beginning, if it can be read again: for a stream of which too many vertices are in use at once.
  std::function<std::unique_ptr<MeshReader>()> read_again = {};
};

// Counts in one pass, while only the triangles around unfinished vertices are held. A mesh that does not finalize its
// vertices is first read for their last uses (ooc/chunks/last_use.h); a reader's, which cannot be looked up, is spooled
// for that. A mesh of which that is too much is sorted on disk before (ooc/whole_mesh/reorder.h).
//
// A reader that is an image, or that lists a cell, is not a surface. A mesh that is read from `mesh` has triangles
// only.
//
// MEMORY: some 400 bytes for each vertex in use at once, and the tables of the steps before, all reserved.
// TIME: two or three readings of the mesh; O(n log n) where it is sorted.
// THROWS: Error of the input, the budget or the disk; what the options throw.
MeshCensus take_census(IndexedMesh& mesh, unsigned dimension, Workspace& space, const CensusOptions& options = {});
MeshCensus take_census(MeshReader& reader, Workspace& space, const CensusOptions& options = {});

}  // namespace reeb::ooc
