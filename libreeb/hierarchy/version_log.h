// Writes down which arcs live between which steps: the partially persistent graph
// (docs/SEMANTICS.md, Levels).
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/working_graph.h"
#include "libreeb/port/record_sink.h"

namespace reeb {

// Collects the arcs that a step changes. An arc with the same ends before and after a step, even if
// it was cut and joined again on the way, keeps its record, unless its content follows (canceller.h):
// then a touched arc always starts a new one. Records go to a sink as they end, with what the arc had
// before the step.
//
// MEMORY: 4 bytes an arc; 28 an arc that a step changes, until it ends.
class VersionLog {
 public:
  // Both must outlive this.
  VersionLog(const WorkingGraph& graph, RecordSink& sink) : graph_(graph), sink_(sink) {
    born_.assign(graph.end_arc().value(), 0);
  }

  void prefetch(ArcId arc) const { __builtin_prefetch(&born_[arc]); }

  // To be called before an arc is moved or removed.
  void touch(ArcId arc) {
    if (born_[arc] == step_) return;
    ended_.push_back({record(arc), arc});
    born_[arc] = step_;
  }

  // Ends the step and starts the next.
  template <class Content>
  void commit(Content& content) {
    std::sort(ended_.begin(), ended_.end(), in_order);
    if constexpr (!Content::kFollows) go_on_with_unchanged();
    for (auto ended = ended_.rbegin(); ended != ended_.rend(); ++ended) {
      ended->version.died = step_;
      sink_.add(ended->version, content.before_step(ended->arc));
    }
    ended_.clear();
    content.commit();
    ++step_;
  }

  // Hands over the arcs of the last version. To be called once, at the end.
  template <class Content>
  void finish(const Content& content) {
    std::vector<ArcId> arcs;
    for (ArcId arc; arc < graph_.end_arc(); ++arc)
      if (graph_.alive(arc)) arcs.push_back(arc);
    std::sort(arcs.begin(), arcs.end(), [this](ArcId a, ArcId b) { return in_order({record(b), b}, {record(a), a}); });
    for (const ArcId arc : arcs) sink_.add(record(arc), content.before_step(arc));
  }

 private:
  // A version that this step touched, as it was before, and the arc it belongs to.
  struct Ended {
    ArcVersion version;
    ArcId arc;
  };

  // Records that have ended go on where an arc has their ends after the step, too.
  void go_on_with_unchanged() {
    changed_.clear();
    for (const Ended& ended : ended_)
      if (graph_.alive(ended.arc)) changed_.push_back(ended.arc);
    std::sort(changed_.begin(), changed_.end(), [this](ArcId a, ArcId b) { return ends(record(a)) < ends(record(b)); });
    auto arc = changed_.begin();
    std::erase_if(ended_, [&](const Ended& ended) {
      while (arc != changed_.end() && ends(record(*arc)) < ends(ended.version)) ++arc;
      if (arc == changed_.end() || ends(record(*arc)) != ends(ended.version)) return false;
      born_[*arc++] = ended.version.born;
      return true;
    });
  }

  ArcVersion record(ArcId arc) const { return {graph_.end(arc, kDown), graph_.end(arc, kUp), born_[arc]}; }
  static bool in_order(const Ended& a, const Ended& b) {
    return std::tuple(ends(a.version), a.version.born, a.arc) < std::tuple(ends(b.version), b.version.born, b.arc);
  }
  static std::tuple<NodeId, NodeId> ends(const ArcVersion& v) { return {v.lo, v.hi}; }

  const WorkingGraph& graph_;
  RecordSink& sink_;
  std::uint32_t step_ = 1;
  IdVector<ArcId, std::uint32_t> born_;  // of each arc's present version
  std::vector<Ended> ended_;
  std::vector<ArcId> changed_;  // arcs of ended_ that are still there
};

}  // namespace reeb
