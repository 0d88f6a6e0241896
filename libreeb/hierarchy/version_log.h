// Records between which versions each arc lives (docs/SEMANTICS.md, Levels).
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "libreeb/graph/direction.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/working_graph.h"
#include "libreeb/port/record_sink.h"

namespace reeb {

struct ArcEnds {
  NodeId lo, hi;
};
inline ArcEnds ends_along(Direction d, NodeId start, NodeId end) {
  return d == kUp ? ArcEnds{start, end} : ArcEnds{end, start};
}

// An arc of the last version, by its number in the full graph.
struct LivingArc {
  ArcId arc;
  ArcEnds ends;
};

// Collects the arcs that a step changes. When a record ends, it goes to a sink, with the content that the arc had
// before the step. Without content (arc_changes.h), an arc with the same ends before and after a step keeps its record,
// even if the step cut it and joined it again. With content, every touched arc starts a new record.
//
// MEMORY: 4 bytes per arc; 28 per arc that a step changes, until the step ends.
template <class Graph = WorkingGraph>
class VersionLog {
 public:
  // Both must outlive this.
  VersionLog(const Graph& graph, RecordSink& sink)
      : graph_(graph),
        sink_(sink),
        born_(graph.tables().template table<ArcId>(graph.end_arc().value(), std::uint32_t{0})) {}

  void prefetch(ArcId arc) const { graph_.tables().prefetch(born_, arc); }

  // To be called before an arc is moved or removed, with its ends.
  void touch(ArcId arc, const ArcEnds& ends) {
    const std::uint32_t born = std::as_const(born_)[arc];
    if (born == step_) return;
    ended_.push_back({{ends.lo, ends.hi, born}, arc});
    born_[arc] = step_;
  }

  // Ends the step and starts the next.
  template <class Content>
  void commit(Content& content) {
    std::sort(ended_.begin(), ended_.end(), in_order);
    if constexpr (!Content::kFollows) continue_unchanged();
    for (auto ended = ended_.rbegin(); ended != ended_.rend(); ++ended) {
      ended->version.died = step_;
      sink_.add(ended->version, content.before_step(ended->arc));
    }
    ended_.clear();
    content.commit();
    ++step_;
  }

  // Passes on the arcs of the last version. To be called once, at the end. For each of `arcs`, living_arc_of()
  // says which arc of the full graph it is, and its ends.
  template <class Content, class LivingArcOf>
  void finish(const Content& content, std::vector<ArcId> arcs, const LivingArcOf& living_arc_of) {
    const auto present = [&](ArcId number) -> Ended {
      const auto [arc, ends] = living_arc_of(number);
      return {{ends.lo, ends.hi, std::as_const(born_)[arc]}, arc};
    };
    std::sort(arcs.begin(), arcs.end(), [&](ArcId a, ArcId b) { return in_order(present(b), present(a)); });
    for (const ArcId number : arcs) {
      const auto [version, arc] = present(number);
      sink_.add(version, content.before_step(arc));
    }
  }

 private:
  // A version that this step touched, as it was before, and the arc it belongs to.
  struct Ended {
    ArcVersion version;
    ArcId arc;
  };

  // An ended record continues if, after the step, a changed arc has the same ends.
  void continue_unchanged() {
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

  const Graph& graph_;
  RecordSink& sink_;
  std::uint32_t step_ = 1;
  typename Graph::Tables::template Table<ArcId, std::uint32_t> born_;  // of each arc's present version
  std::vector<Ended> ended_;
  std::vector<ArcId> changed_;  // arcs of ended_ that still exist
};

}  // namespace reeb
