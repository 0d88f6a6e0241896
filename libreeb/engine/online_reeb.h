// The on-line Reeb graph: it takes vertices, simplices and finalizations, and yields an exact graph at any moment.
//
// Simplices are collected into small batches. A batch is swept alone into a fragment, and the fragment is glued to the
// live graph, by the same code as in the parallel pipeline. Settled nodes and arcs are passed on to the sink.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "libreeb/base/ids.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/port/graph_sink.h"

namespace reeb {

// THREADS: one thread at a time for each object, also for snapshot(). Different objects share nothing. The thread that
//          adds also calls the sink.
// TIME:    adding only collects. Each full batch costs O(k log k) for k simplices, and the paths that gluing goes over,
//          which are short where the live graph is small.
// MEMORY:  the front (vertices that are not finalized, and the edges between them), the live graph and one batch;
//          without a sink also the settled graph, 32 bytes per arc. Without finalize() the front is the whole mesh: 4
//          to 12 KB per triangle. For a mesh in a file, reeb::compute() is then the better choice: it finds out by
//          itself which vertices are final.
// An Error from a call leaves the graph as it was before the call; one from a sink does not.
class OnlineReeb {
 public:
  struct Options {
    std::size_t batch_triangles = 4096;  // 1: glue every triangle at once
    // Leaves of less persistence are removed as soon as they are certain to be noise; the others stay.
    double noise_below = 0;
    // The values so far span this number of buckets of the embedding, or up to twice that number; at most 2^20.
    // 0: no embedding. Only a sink gets buckets.
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

  // Announces that no later simplex names `v`.
  // THROWS: Error{kBadInput} if `v` was not added or was finalized before, or after finish().
  void finalize(VertexId v);

  // The exact Reeb graph of everything added so far, whether finalized or not, without removed noise. With a sink, only
  // the part that was not yet passed on. O(live graph), plus O(settled graph) without a sink.
  ReebGraph snapshot();

  // Pairs that were removed as noise so far.
  std::uint64_t removed_pairs() const;

  // Finalizes all remaining vertices and passes on the rest of the graph. Nothing can be added afterwards. Without a
  // sink, snapshot() still returns the whole graph. A second call does nothing.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reeb
