// A level of a `.reeb` file that is refined and coarsened in place, for viewers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {

// Receives every change, in an order in which an arc only ever joins nodes that exist. Nodes are named by their file
// index, arcs by their record: both keep their meaning as long as the file exists.
class GraphListener {
 public:
  virtual ~GraphListener() = default;
  virtual void node_added(std::uint32_t node, const SettledNode& place) = 0;
  virtual void node_removed(std::uint32_t node) = 0;
  virtual void arc_added(std::uint64_t arc, std::uint32_t lo, std::uint32_t hi) = 0;
  virtual void arc_removed(std::uint64_t arc) = 0;
};

// Begins empty.
//
// TIME:    refining reads only the frames that follow; coarsening reads again those that the coarser level
//          needs. Either costs time proportional to the larger level.
// MEMORY:  what level_memory says for the level, and the nodes of at most one further frame.
// THREADS: one at a time; several objects may share a file. The listener is called by the thread that moves
//          the graph, and must not move it.
// THROWS:  as ReebFile; then the level is unchanged. What the listener throws, once the level has changed as it should;
//          that listener is told nothing more.
class ProgressiveGraph {
 public:
  // Both must outlive this; `listener` may be null.
  explicit ProgressiveGraph(const ReebFile& file, GraphListener* listener = nullptr);
  ProgressiveGraph(ProgressiveGraph&&) noexcept;
  ~ProgressiveGraph();

  // THROWS: Error{kBadInput} if the file has no such version, as ReebFile::load.
  void go_to_version(std::uint32_t version);
  // As version_at() and its like in ReebFile say.
  void go_to_threshold(double threshold);
  void go_to_nodes(std::uint64_t limit);
  void go_to_memory(std::uint64_t limit);

  bool empty() const;
  std::uint32_t version() const;
  std::size_t node_count() const;
  std::size_t arc_count() const;
  std::uint64_t memory_bytes() const;  // held for nodes and arcs

  // A copy in canonical order. O(n log n).
  ReebGraph graph() const;

 private:
  class Impl;
  const ReebFile* file_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace reeb::ooc
