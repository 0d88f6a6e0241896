#include "libreeb/hierarchy/path_follower.h"

#include <algorithm>

namespace reeb {

PathFollower::PathFollower(const WorkingGraph& graph) : graph_(graph), exits_{kNone} {
  stretch_of_.assign(graph.end_node().value(), {kNoStretch, kNoStretch});
}

// Makes a stretch of the nodes that were followed before `exit`, if they are enough.
void PathFollower::keep_followed(NodeId exit, Direction d) {
  if (!followed_.empty() && followed_.back() == exit) followed_.pop_back();
  if (followed_.size() >= kLeastNodes) {
    if (exits_.size() > stretch_of_.size() / kLeastNodes) {
      std::fill(stretch_of_.begin(), stretch_of_.end(), std::array{kNoStretch, kNoStretch});
      exits_.resize(1);
    }
    for (const NodeId node : followed_) stretch_of_[node][d] = static_cast<std::uint32_t>(exits_.size());
    exits_.push_back(exit);
  }
  followed_.clear();
}

void PathFollower::heed_changes() {
  for (const auto [node, d] : changed_) {
    NodeId& exit = exits_[stretch_of_[node][d]];
    if (exit != kNone && !still_leads_on(node, d)) exit = kNone;
  }
  changed_.clear();
}

// Whether the path from a node of a stretch still goes on in it, or to its exit; nodes that were put
// between become part of it, and one that is gone is on no path any more.
bool PathFollower::still_leads_on(NodeId node, Direction d) {
  const std::uint32_t stretch = stretch_of_[node][d];
  const auto is_in = [&](NodeId other) { return other == exits_[stretch] || stretch_of_[other][d] == stretch; };
  std::array<NodeId, kMostPutBetween> between{};
  std::size_t count = 0;
  NodeId to = next(node, d);
  if (to == kNone) {
    if (graph_.nearest(node, opposite(d)) != ArcId::none()) return false;
    stretch_of_[node][d] = kNoStretch;
    return true;
  }
  for (; !is_in(to); to = next(to, d)) {
    if (count == between.size() || exit_of(to, d) != kNone || next(to, d) == kNone) return false;
    between[count++] = to;
  }
  for (std::size_t i = 0; i < count; ++i) stretch_of_[between[i]][d] = stretch;
  return true;
}

}  // namespace reeb
