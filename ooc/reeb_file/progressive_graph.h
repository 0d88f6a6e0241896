// A level of a `.reeb` file that is refined and coarsened in place, for viewers.
#pragma once

#include <cstdint>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {

// Told of every change, in an order in which an arc only ever joins nodes that are there. Nodes go
// by their file index, arcs by their record: both mean the same for as long as the file does.
class GraphListener {
 public:
  virtual ~GraphListener() = default;
  virtual void node_added(std::uint32_t node, const SettledNode& place) = 0;
  virtual void node_removed(std::uint32_t node) = 0;
  virtual void arc_added(std::uint64_t arc, std::uint32_t lo, std::uint32_t hi) = 0;
  virtual void arc_removed(std::uint64_t arc) = 0;
};

// Begins empty. Refining reads only the frames that follow; coarsening reads again those that the
// coarser level needs. Either costs time proportional to the larger level.
// MEMORY: what level_memory says of the level, and the nodes of at most one frame more.
// THROWS: as ReebFile; then the level is what it was before.
class ProgressiveGraph {
 public:
  // Both must outlive this; `listener` may be null.
  explicit ProgressiveGraph(const ReebFile& file, GraphListener* listener = nullptr);

  // THROWS: Error{kBadInput} if the file has no such version, as ReebFile::load.
  void go_to_version(std::uint32_t version);
  void go_to_threshold(double threshold) { go_to_version(file_.version_at(threshold)); }
  void go_to_nodes(std::uint64_t limit) { go_to_version(file_.finest_with_nodes(limit)); }
  void go_to_memory(std::uint64_t limit) { go_to_version(file_.finest_with_memory(limit)); }

  bool empty() const { return !loaded_; }
  std::uint32_t version() const { return version_; }
  std::size_t node_count() const { return node_count_; }
  std::size_t arc_count() const { return arcs_.size(); }
  std::uint64_t memory_bytes() const;  // held for nodes and arcs

  // A copy in canonical order.
  ReebGraph graph() const;

 private:
  struct Node {
    SettledNode place;
    std::uint32_t degree;  // isolated points have one more than arcs
  };
  struct Arc {
    std::uint64_t record;
    std::uint32_t lo, hi, born, died;
  };
  struct Change;
  // The frames whose records `version` needs, from a bookmark on.
  Change gather(std::uint32_t version) const;
  void apply(Change change, std::uint32_t version);
  void add_reference(std::uint32_t node);
  void drop_reference(std::uint32_t node);

  const ReebFile& file_;
  GraphListener* listener_;
  bool loaded_ = false;
  std::uint32_t version_ = 0;
  std::vector<Node> nodes_;  // by file index
  std::vector<Arc> arcs_;    // live, in no order
  std::size_t node_count_ = 0;
  FrameCursor last_frame_;         // before the last frame read: its rest is needed next
  std::uint64_t last_record_ = 0;  // record index at that bookmark
};

}  // namespace reeb::ooc
