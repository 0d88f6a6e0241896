#include "ooc/stored_hierarchy/introduced_nodes.h"

#include <stdexcept>
#include <string>

namespace reeb::ooc {

SettledNode IntroducedNodes::next(NodeId node, StoredNodes& nodes) {
  if (!sorted_) sort(nodes);
  if (at_ == batch_.size()) {
    at_ = 0;
    sorted_->read(batch_, kAtOnce);
  }
  if (at_ == batch_.size() || batch_[at_].at.node != node)
    throw std::logic_error("node " + std::to_string(node.value()) + " is not the next that a frame introduces");
  return batch_[at_++].node;
}

void IntroducedNodes::sort(StoredNodes& nodes) {
  frames_->finish();
  sorted_.emplace("nodes by frame", temp_, budget_, sorting_);
  for (std::vector<Introduction> some; frames_->read(some, kAtOnce);)
    for (const Introduction& at : some) sorted_->add(Node{at, nodes.node(at.node)});
  spilled_ += frames_->spilled_bytes();
  frames_.reset();
  sorted_->finish();
}

}  // namespace reeb::ooc
