// Writes down which arcs live between which steps: the partially persistent graph (DESIGN.md 6).
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/working_graph.h"

namespace reeb {

// Collects the arcs that a step changes. An arc with the same ends before and after a step, even if
// it was cut and joined again on the way, keeps its record.
//
// MEMORY: 4 bytes an arc and 16 bytes a record.
class VersionLog {
 public:
  explicit VersionLog(const WorkingGraph& graph) : graph_(graph), born_(graph.arc_count()) {}

  // To be called before an arc is moved or removed.
  void touch(std::uint32_t arc) {
    if (born_[arc] == step_) return;
    ended_.push_back(record(arc));
    born_[arc] = step_;
    changed_.push_back(arc);
  }

  // Ends the step and starts the next.
  void commit() {
    std::erase_if(changed_, [this](std::uint32_t arc) { return !graph_.alive(arc); });
    std::sort(changed_.begin(), changed_.end(), [this](std::uint32_t a, std::uint32_t b) {
      return ends(record(a)) < ends(record(b));
    });
    std::sort(ended_.begin(), ended_.end(), [](const ArcVersion& a, const ArcVersion& b) {
      return std::tuple(a.lo, a.hi, a.born) < std::tuple(b.lo, b.hi, b.born);
    });
    auto arc = changed_.begin();
    for (ArcVersion& old : ended_) {
      while (arc != changed_.end() && ends(record(*arc)) < ends(old)) ++arc;
      if (arc != changed_.end() && ends(record(*arc)) == ends(old)) {
        born_[*arc++] = old.born;
      } else {
        old.died = step_;
        records_.push_back(old);
      }
    }
    ended_.clear();
    changed_.clear();
    ++step_;
  }

  // All records: those that died, by step, then (lo, hi, born); then the arcs of the last version.
  std::vector<ArcVersion> take() {
    for (std::uint32_t arc = 0; arc < graph_.arc_count(); ++arc)
      if (graph_.alive(arc)) records_.push_back(record(arc));
    return std::move(records_);
  }

 private:
  ArcVersion record(std::uint32_t arc) const {
    return {NodeId(graph_.end(arc, kDown)), NodeId(graph_.end(arc, kUp)), born_[arc]};
  }
  static std::tuple<NodeId, NodeId> ends(const ArcVersion& v) { return {v.lo, v.hi}; }

  const WorkingGraph& graph_;
  std::uint32_t step_ = 1;
  std::vector<std::uint32_t> born_;     // of each arc's present version
  std::vector<ArcVersion> ended_;       // versions that this step touched, as they were before it
  std::vector<std::uint32_t> changed_;  // the arcs they belong to
  std::vector<ArcVersion> records_;
};

}  // namespace reeb
