// The progress of a run, and its results.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/base/sweep_key.h"
#include "libreeb/base/value_range.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/port/simplex_counts.h"

namespace reeb::ooc {

struct ComputeProgress {
  enum class Phase { kSpool, kFinalization, kReorder, kReeb, kHierarchy };
  Phase phase;
  std::uint64_t done = 0, total = 0;  // in one unit; total 0: unknown
  std::uint64_t triangles = 0;        // so far
};

// The largest numbers of live vertices, edges and arcs at the end of a chunk, over all functions; and the most memory
// that the live graphs took.
struct LiveMaximum {
  std::uint64_t vertices = 0, edges = 0, arcs = 0, bytes = 0;
};

struct PhaseSeconds {
  double wall = 0, finalization = 0, reorder = 0, reeb = 0, hierarchy = 0;
};

// A pair for people to read. So many of each kind are kept.
inline constexpr std::size_t kMostFeatures = 5;
struct Feature {
  PairType type;
  SweepKey lo, hi;
};

// The results of a run for one function.
struct ComputeResult {
  std::string function, output;
  ValueRange range;  // of the function; min > max without vertices
  std::uint64_t vertices = 0, unused_vertices = 0;
  SimplexCounts simplices{};  // as the mesh lists them
  std::uint64_t degenerate_triangles = 0;
  std::uint64_t triangles() const { return simplices[2]; }
  std::uint64_t nodes = 0, arcs = 0;
  BettiNumbers betti;
  std::array<std::uint64_t, 4> pairs{};  // by PairType
  std::uint64_t kept_loops = 0, denoised_pairs = 0;
  bool reordered = false;
  std::uint64_t guessed_vertices = 0;  // vertices guessed to be complete in the first reading of the mesh,
  std::uint64_t revoked_guesses = 0;   // and how many of these guesses were wrong: then the mesh was run from disk
  // Up to five loops, and up to five minima and maxima, of positive persistence, largest first.
  std::vector<Feature> largest;
  // Of a graph with a hierarchy: the number of loops that are likely defects of the mesh, since a gap divides their
  // persistences from those of larger ones; and the largest persistence of them.
  std::uint64_t likely_defects = 0;
  double likely_defects_up_to = 0;
  std::uint64_t spilled_bytes = 0;
  unsigned threads = 1;  // the most that the run could use
  LiveMaximum live;
  PhaseSeconds seconds;
  std::vector<std::string> notes;  // one line each about something odd but harmless
};

}  // namespace reeb::ooc
