// The on-line Reeb graph: it takes vertices, simplices and finalizations, and yields an exact graph at any moment.
//
// Simplices are collected into small batches. A batch is swept alone into a fragment, and the fragment is glued to the
// live graph, by the same code as in the parallel pipeline. Settled nodes and arcs are passed on to the sink. A
// triangle takes far less memory than what gluing would keep of it while none of its vertices is final. So triangles
// wait until enough vertices are final, and a snapshot sweeps those that wait.
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
// TIME:    adding a simplex or finalizing a vertex takes O(log k) for k that wait, on average, and the steps of the
//          paths that gluing goes over, which are short where the live graph is small.
// MEMORY:  the vertices that are not final, the simplices that wait (see Options::waiting_triangles), and the live
//          graph; without a sink also the settled graph, 32 bytes per arc. Where each vertex is finalized after its
//          last simplex, that is little: 1 to 3 KB per vertex that is used and not final. Without finalize() all
//          simplices wait: 60 bytes per triangle of a surface in any order, and 60 to 130 more during snapshot() and
//          finish(). For a mesh in a file, reeb::compute() is then the better choice: it finds out by itself which
//          vertices are final.
// An Error from a call leaves the graph as it was before the call; one from a sink does not.
class OnlineReeb {
 public:
  struct Options {
    std::size_t batch_triangles = 4096;  // at least that many simplices are swept at a time
    // Simplices wait until three quarters of their vertices are final; then those with a final vertex are glued. If
    // more than this number wait, all of them are glued. That can take 12 KB per triangle, but less where few vertices
    // have very many simplices. Never more than 2^30 wait.
    std::size_t waiting_triangles = std::size_t{1} << 30;
    // Leaves of less persistence are removed as soon as they are certain to be noise; the others stay.
    double noise_below = 0;
    // The values so far span this number of buckets of the embedding, or up to twice that number; at most 2^20.
    // 0: no embedding. Only a sink gets buckets, and positions of nodes.
    std::uint32_t buckets = 0;
  };

  // Settled nodes and arcs go to `sink`; without one they are kept here. THROWS: Error{kUsage} of bad options.
  OnlineReeb();
  explicit OnlineReeb(Options options, GraphSink* sink = nullptr);
  ~OnlineReeb();
  OnlineReeb(OnlineReeb&&) noexcept;
  OnlineReeb& operator=(OnlineReeb&&) noexcept;

  // Adds the next vertex and returns its index: 0, 1, 2, ...
  // THROWS: Error{kBadInput} if the value or the position is not finite, or after finish().
  VertexId add_vertex(double value, const Point& position = {});
  // Says that no vertex has an index below `next`, except those that were added: the next one has this index.
  void skip_to(VertexId next);

  // Adds the simplex with this set of corners (repeats are ignored), of any dimension; the
  // triangles through its vertex of lowest index decide.
  // THROWS: Error{kBadInput} if a corner was not added or was finalized, or after finish().
  void add_simplex(std::span<const VertexId> corners);

  // Announces that no later simplex names `v`.
  // THROWS: Error{kBadInput} if `v` was not added or was finalized before, or after finish().
  void finalize(VertexId v);

  // The exact Reeb graph of everything added so far, whether finalized or not, without removed noise. With a sink, only
  // the part that was not yet passed on. It sweeps the simplices that wait, in O(k log k) for k of them, however many
  // were there at the last snapshot. In addition it takes O(live graph), and O(settled graph) without a sink. Where
  // most vertices are final, that is little. Without finalize() it is all that was added: about 0.1 to 0.3 µs per
  // triangle.
  ReebGraph snapshot();

  // What it holds, and in addition what snapshot() or finish() would take now; a bound that holds for some further
  // simplices too.
  std::uint64_t memory_bytes() const;

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
