// The on-line Reeb graph: vertices, simplices and finalizations in, an exact graph out at any
// moment.
//
// Simplices are collected into small batches and glued with the same code as the parallel
// pipeline: a batch is swept alone into a fragment, and the fragment is glued to the live graph.
// What is finalized and can no longer change is handed to the sink and forgotten.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "libreeb/base/ids.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

// THREADS: one at a time for each object, snapshot() included. Different objects share nothing. A sink
//          is called by the thread that adds.
// TIME:    adding collects; each full batch costs O(k log k) for k simplices, and the paths that gluing
//          goes over, which are short where the live graph is small.
// MEMORY:  grows with the front (vertices that are not finalized, and the edges between them), the live
//          graph and one batch; without a sink also with the settled graph, 32 bytes an arc. Without
//          finalize() the front is the whole mesh: 4 to 12 KB a triangle. Then a mesh in a file is better
//          given to reeb::compute(), which finds out by itself what is final.
// An Error from a call leaves the graph as it was before the call; one from a sink does not.
class OnlineReeb {
 public:
  struct Options {
    std::size_t batch_triangles = 4096;  // 1: glue every triangle at once
    // Leaves of less persistence are removed where it is already sure that they are noise; what is not
    // sure yet stays.
    double noise_below = 0;
    // The values so far span this many buckets of the embedding, or up to twice as many; at most
    // 2^20. 0: no embedding. Buckets reach a sink only.
    std::uint32_t buckets = 0;
  };

  // Settled nodes and arcs go to `sink`; without one they are kept here.
  OnlineReeb();
  explicit OnlineReeb(Options options, GraphSink* sink = nullptr);
  ~OnlineReeb();
  OnlineReeb(OnlineReeb&&) noexcept;
  OnlineReeb& operator=(OnlineReeb&&) noexcept;

  // Adds the next vertex and returns its index: 0, 1, 2, ...
  // THROWS: Error{kBadInput} if the value is not finite, or after finish().
  VertexId add_vertex(double value, const Point& position = {});

  // Adds the simplex with this set of corners (repeats are ignored), of any dimension; it counts
  // through its 2-skeleton.
  // THROWS: Error{kBadInput} if a corner was not added or was finalized, or after finish().
  void add_simplex(std::span<const VertexId> corners);

  // Promises that no later simplex names `v`.
  // THROWS: Error{kBadInput} if `v` was not added or was finalized before, or after finish().
  void finalize(VertexId v);

  // The exact Reeb graph of everything added so far, whether finalized or not, less what was
  // removed as noise. O(live graph) plus what is kept here; with a sink, only what was not yet
  // handed over.
  ReebGraph snapshot();

  // Pairs that were removed as noise so far.
  std::uint64_t removed_pairs() const;

  // Finalizes all that is left and hands it over. Nothing can be added afterwards; snapshot() still gives
  // what is kept here. A second call does nothing.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reeb
