#include "ooc/stored_hierarchy/introduced_nodes.h"

#include <stdexcept>
#include <string>

namespace reeb::ooc {

SettledNode IntroducedNodes::next(NodeId node, StoredNodes& nodes) {
  if (!sorted_) sort(nodes);
  Node next;
  if (!cursor_.next(*sorted_, next) || next.at.node != node)
    throw std::logic_error("node " + std::to_string(node.value()) + " is not the next that a frame introduces");
  return next.node;
}

void IntroducedNodes::sort(StoredNodes& nodes) {
  frames_->finish();
  sorted_.emplace("nodes by frame", temp_, budget_, sorting_);
  RecordCursor<Introduction> frames;
  for (Introduction at; frames.next(*frames_, at);) sorted_->add(Node{at, nodes.node(at.node)});
  spilled_ += frames_->spilled_bytes();
  frames_.reset();
  sorted_->finish();
}

}  // namespace reeb::ooc
