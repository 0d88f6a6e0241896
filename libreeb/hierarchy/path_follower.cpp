#include "libreeb/hierarchy/path_follower.h"

#include <algorithm>

namespace reeb {

PathFollower::PathFollower(const WorkingGraph& graph) : graph_(graph), exits_{kNone} {
  section_of_.assign(graph.end_node().value(), {kNoSection, kNoSection});
}

// Makes a section of the nodes that were followed before `exit`, if there are enough of them.
void PathFollower::keep_followed(NodeId exit, Direction d) {
  if (!followed_.empty() && followed_.back() == exit) followed_.pop_back();
  if (followed_.size() >= kMinNodes) {
    if (exits_.size() > section_of_.size() / kMinNodes) {
      std::fill(section_of_.begin(), section_of_.end(), std::array{kNoSection, kNoSection});
      exits_.resize(1);
    }
    for (const NodeId node : followed_) section_of_[node][d] = static_cast<std::uint32_t>(exits_.size());
    exits_.push_back(exit);
  }
  followed_.clear();
}

void PathFollower::apply_changes() {
  for (const auto [node, d] : changed_) {
    NodeId& exit = exits_[section_of_[node][d]];
    if (exit != kNone && !still_leads_to_exit(node, d)) exit = kNone;
  }
  changed_.clear();
}

// Whether the path from a node of a section still leads to another node of the section, or to its exit. Nodes that were
// inserted on the way become part of the section. A node that was removed leaves it.
bool PathFollower::still_leads_to_exit(NodeId node, Direction d) {
  const std::uint32_t section = section_of_[node][d];
  const auto is_in = [&](NodeId other) { return other == exits_[section] || section_of_[other][d] == section; };
  std::array<NodeId, kMaxInserted> inserted{};
  std::size_t count = 0;
  NodeId to = next(node, d);
  if (to == kNone) {
    if (graph_.nearest(node, opposite(d)) != ArcId::none()) return false;
    section_of_[node][d] = kNoSection;
    return true;
  }
  for (; !is_in(to); to = next(to, d)) {
    if (count == inserted.size() || exit_of(to, d) != kNone || next(to, d) == kNone) return false;
    inserted[count++] = to;
  }
  for (std::size_t i = 0; i < count; ++i) section_of_[inserted[i]][d] = section;
  return true;
}

}  // namespace reeb
