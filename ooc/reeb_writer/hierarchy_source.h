// The nodes and pairs of a hierarchy for its file, wherever they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "libreeb/base/prefetch.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {

// THREADS: one at a time.
class HierarchySource {
 public:
  HierarchySource() = default;
  HierarchySource(const HierarchySource&) = delete;
  HierarchySource& operator=(const HierarchySource&) = delete;
  virtual ~HierarchySource() = default;

  virtual std::size_t node_count() const = 0;
  virtual bool has_positions() const = 0;
  virtual SweepKey key(NodeId id) = 0;
  // Says which frame introduces a node. To be called once for each node, frame by frame.
  virtual void introduce(NodeId /*id*/, std::uint32_t /*frame*/) {}
  // The node of this rank; without positions, zeros. REQUIRES: introduce() was called for all nodes. This is called
  // once for each, frame by frame, and for the nodes of a frame in the order of ranks.
  virtual SettledNode node(NodeId id) = 0;
  // To be called some time before node().
  virtual void prefetch(NodeId /*id*/) const {}

  // Pairs in the order of cancelling. rewind_pairs() starts over; next_pair() is false at the end.
  virtual void rewind_pairs() = 0;
  virtual bool next_pair(PersistencePair& pair) = 0;

  // As in Hierarchy.
  virtual std::span<const double> persistence() const = 0;
  virtual std::span<const NodeId> isolated() const = 0;
};

// All of it in memory. The arcs are not read, neither those of the graph nor the records.
class HierarchyInMemory : public HierarchySource {
 public:
  // Both must outlive this.
  HierarchyInMemory(const ReebGraph& graph, const Hierarchy& hierarchy) : graph_(graph), hierarchy_(hierarchy) {}

  std::size_t node_count() const override { return graph_.node_count(); }
  bool has_positions() const override { return !graph_.positions.empty(); }
  SweepKey key(NodeId id) override { return graph_.nodes[id.value()]; }
  SettledNode node(NodeId id) override {
    return {graph_.nodes[id.value()], has_positions() ? graph_.positions[id.value()] : Point{}};
  }
  void prefetch(NodeId id) const override {
    reeb::prefetch(&graph_.nodes[id.value()]);
    if (has_positions()) reeb::prefetch(&graph_.positions[id.value()]);
  }
  void rewind_pairs() override { next_ = 0; }
  bool next_pair(PersistencePair& pair) override {
    if (next_ == hierarchy_.pairs.size()) return false;
    pair = hierarchy_.pairs[next_++];
    return true;
  }
  std::span<const double> persistence() const override { return hierarchy_.persistence; }
  std::span<const NodeId> isolated() const override { return hierarchy_.isolated; }

 private:
  const ReebGraph& graph_;
  const Hierarchy& hierarchy_;
  std::size_t next_ = 0;
};

}  // namespace reeb::ooc
