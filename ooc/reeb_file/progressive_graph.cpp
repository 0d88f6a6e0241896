#include "ooc/reeb_file/progressive_graph.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

#include "ooc/reeb_file/frame_file.h"

namespace reeb::ooc {

class ProgressiveGraph::Impl {
 public:
  Impl(const FrameFile& file, GraphListener* listener) : file_(file), listener_(listener), last_frame_(file) {}

  void go_to_version(std::uint32_t version);
  bool empty() const { return !loaded_; }
  std::uint32_t version() const { return version_; }
  std::size_t node_count() const { return node_count_; }
  std::size_t arc_count() const { return arcs_.size(); }
  std::uint64_t memory_bytes() const;
  ReebGraph graph() const;

 private:
  struct Node {
    SettledNode place;
    std::uint32_t degree;  // the number of arcs; isolated points have 1
  };
  struct Arc {
    std::uint64_t record;
    std::uint32_t lo, hi, born, died;
  };
  // Everything that must be read before the level is touched, so that a bad frame changes nothing.
  struct Change {
    std::vector<Node> nodes;      // in addition to those in memory
    std::size_t nodes_total = 0;  // introduced by the frames that the version needs
    std::vector<Arc> arcs;        // that are live at the version and not in memory
    FrameCursor last_frame;
    std::uint64_t last_record = 0;
  };
  // Reads the frames whose records `version` needs, starting at a bookmark.
  Change gather(std::uint32_t version) const;
  // How many nodes the level will have.
  std::uint64_t nodes_after(const Change& change, std::uint32_t version) const;
  void apply(Change change, std::uint32_t version);
  void add_reference(std::uint32_t node);
  void drop_reference(std::uint32_t node);
  // A change is made as a whole, even if the listener throws within it.
  template <class Call>
  void tell(const Call& call) {
    if (listener_ == nullptr) return;
    try {
      call(*listener_);
    } catch (...) {
      failure_ = std::current_exception();
      listener_ = nullptr;
    }
  }

  const FrameFile& file_;
  GraphListener* listener_;
  std::exception_ptr failure_;  // of the listener, not yet thrown
  bool loaded_ = false;
  std::uint32_t version_ = 0;
  std::vector<Node> nodes_;  // by file index
  std::vector<Arc> arcs_;    // live, in unspecified order
  std::size_t node_count_ = 0;
  FrameCursor last_frame_;         // before the last frame read: its rest is needed next
  std::uint64_t last_record_ = 0;  // record index at that bookmark
};

ProgressiveGraph::ProgressiveGraph(const ReebFile& file, GraphListener* listener)
    : file_(&file), impl_(std::make_unique<Impl>(*file.frames_, listener)) {}
ProgressiveGraph::ProgressiveGraph(ProgressiveGraph&&) noexcept = default;
ProgressiveGraph::~ProgressiveGraph() = default;

void ProgressiveGraph::go_to_version(std::uint32_t version) { impl_->go_to_version(version); }
void ProgressiveGraph::go_to_threshold(double threshold) { go_to_version(file_->version_at(threshold)); }
void ProgressiveGraph::go_to_nodes(std::uint64_t limit) { go_to_version(file_->finest_with_nodes(limit)); }
void ProgressiveGraph::go_to_memory(std::uint64_t limit) { go_to_version(file_->finest_with_memory(limit)); }
bool ProgressiveGraph::empty() const { return impl_->empty(); }
std::uint32_t ProgressiveGraph::version() const { return impl_->version(); }
std::size_t ProgressiveGraph::node_count() const { return impl_->node_count(); }
std::size_t ProgressiveGraph::arc_count() const { return impl_->arc_count(); }
std::uint64_t ProgressiveGraph::memory_bytes() const { return impl_->memory_bytes(); }
ReebGraph ProgressiveGraph::graph() const { return impl_->graph(); }

void ProgressiveGraph::Impl::go_to_version(std::uint32_t version) {
  if (loaded_ && version == version_) return;
  file_.require_version(version);
  apply(gather(version), version);
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

ProgressiveGraph::Impl::Change ProgressiveGraph::Impl::gather(std::uint32_t version) const {
  const bool refine = loaded_ && version < version_;
  Change change{.nodes = {},
                .nodes_total = 0,
                .arcs = {},
                .last_frame = refine ? last_frame_ : FrameCursor(file_),
                .last_record = refine ? last_record_ : 0};
  FrameCursor cursor = change.last_frame;
  std::uint64_t record = change.last_record;
  GraphFrame frame;
  FrameFile::Buffers buffers;
  VersionCounts counts;
  const auto key_of = [&](std::uint64_t node) -> const SweepKey& {
    return (node < nodes_.size() ? nodes_[node] : change.nodes[node - nodes_.size()]).place.key;
  };
  while (!cursor.covers(version)) {
    const std::uint32_t coarser = cursor.finest_complete();
    change.last_frame = cursor;
    change.last_record = record;
    const std::uint64_t first_node = cursor.nodes_read();
    cursor.next(file_, frame, buffers);
    for (std::size_t i = 0; i < frame.nodes.size(); ++i)
      if (first_node + i >= nodes_.size()) change.nodes.push_back({frame.nodes[i], 0});
    require_rising(file_, cursor, frame, key_of);
    if (cursor.covers(version)) counts = frame.versions[coarser - 1 - version];
    std::vector<bool> named(file_.header().flags.graph_only ? 0 : frame.nodes.size());
    for (const FileArc& arc : frame.arcs) {
      const auto here = [&](std::uint32_t at) { return arc.born <= at && at < arc.died; };
      if (here(version) && !(loaded_ && here(version_)))
        change.arcs.push_back(
            {record, static_cast<std::uint32_t>(arc.lo), static_cast<std::uint32_t>(arc.hi), arc.born, arc.died});
      for (const std::uint64_t end : {arc.lo, arc.hi})
        if (end >= first_node && !named.empty()) named[end - first_node] = true;
      ++record;
    }
    // Nodes that no arc of their own frame names are isolated points: they hold a reference to themselves.
    for (std::size_t i = 0; i < named.size(); ++i)
      if (!named[i] && first_node + i >= nodes_.size()) change.nodes[first_node + i - nodes_.size()].degree = 1;
  }
  change.nodes_total = cursor.nodes_read();
  const auto lives = [&](const Arc& arc) { return arc.born <= version && version < arc.died; };
  const auto stay = static_cast<std::uint64_t>(std::ranges::count_if(arcs_, lives));
  require_counts(file_, cursor, version, counts, nodes_after(change, version), stay + change.arcs.size());
  return change;
}

std::uint64_t ProgressiveGraph::Impl::nodes_after(const Change& change, std::uint32_t version) const {
  std::vector<bool> before(nodes_.size()), after(std::max(nodes_.size(), change.nodes_total));
  for (const Arc& arc : arcs_) {
    before[arc.lo] = before[arc.hi] = true;
    if (arc.born <= version && version < arc.died) after[arc.lo] = after[arc.hi] = true;
  }
  for (const Arc& arc : change.arcs) after[arc.lo] = after[arc.hi] = true;
  for (std::size_t i = 0; i < change.nodes_total; ++i) {
    const bool is_isolated =
        i < nodes_.size() ? nodes_[i].degree != 0 && !before[i] : change.nodes[i - nodes_.size()].degree != 0;
    if (is_isolated) after[i] = true;
  }
  return static_cast<std::uint64_t>(std::ranges::count(after, true));
}

void ProgressiveGraph::Impl::apply(Change change, std::uint32_t version) {
  const std::size_t old_nodes = nodes_.size();
  nodes_.reserve(std::max(nodes_.size(), change.nodes_total));
  nodes_.insert(nodes_.end(), change.nodes.begin(), change.nodes.end());
  for (std::size_t i = old_nodes; i < nodes_.size(); ++i)
    if (nodes_[i].degree != 0) {
      nodes_[i].degree = 0;
      add_reference(static_cast<std::uint32_t>(i));
    }
  // New arcs first: a node that lives before and after is not removed in between.
  const std::size_t old_arcs = arcs_.size();
  arcs_.insert(arcs_.end(), change.arcs.begin(), change.arcs.end());
  for (std::size_t i = old_arcs; i < arcs_.size(); ++i) {
    add_reference(arcs_[i].lo);
    add_reference(arcs_[i].hi);
    tell([&](GraphListener& listener) { listener.arc_added(arcs_[i].record, arcs_[i].lo, arcs_[i].hi); });
  }
  std::erase_if(arcs_, [&](const Arc& arc) {
    if (arc.born <= version && version < arc.died) return false;
    tell([&](GraphListener& listener) { listener.arc_removed(arc.record); });
    drop_reference(arc.lo);
    drop_reference(arc.hi);
    return true;
  });
  nodes_.resize(change.nodes_total);
  nodes_.shrink_to_fit();
  arcs_.shrink_to_fit();
  last_frame_ = change.last_frame;
  last_record_ = change.last_record;
  version_ = version;
  loaded_ = true;
}

void ProgressiveGraph::Impl::add_reference(std::uint32_t node) {
  if (nodes_[node].degree++ != 0) return;
  ++node_count_;
  tell([&](GraphListener& listener) { listener.node_added(node, nodes_[node].place); });
}

void ProgressiveGraph::Impl::drop_reference(std::uint32_t node) {
  if (--nodes_[node].degree != 0) return;
  --node_count_;
  tell([&](GraphListener& listener) { listener.node_removed(node); });
}

std::uint64_t ProgressiveGraph::Impl::memory_bytes() const {
  static_assert(sizeof(Node) == kNodeMemoryBytes && sizeof(Arc) == kArcMemoryBytes);
  return nodes_.capacity() * sizeof(Node) + arcs_.capacity() * sizeof(Arc);
}

ReebGraph ProgressiveGraph::Impl::graph() const {
  ReebGraph graph;
  std::vector<std::uint32_t> order, rank(nodes_.size());
  for (std::uint32_t i = 0; i < nodes_.size(); ++i)
    if (nodes_[i].degree != 0) order.push_back(i);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return nodes_[a].place.key < nodes_[b].place.key; });
  for (const std::uint32_t node : order) {
    rank[node] = static_cast<std::uint32_t>(graph.nodes.size());
    graph.nodes.push_back(nodes_[node].place.key);
    if (file_.header().flags.has_positions) graph.positions.push_back(nodes_[node].place.position);
  }
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  for (const Arc& arc : arcs_) ends.emplace_back(rank[arc.lo], rank[arc.hi]);
  std::sort(ends.begin(), ends.end());
  for (const auto& [lo, hi] : ends) {
    graph.lo.push_back(NodeId(lo));
    graph.hi.push_back(NodeId(hi));
  }
  return graph;
}

}  // namespace reeb::ooc
