#include "libreeb/engine/live_noise.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "libreeb/sweep/sweep_options.h"

namespace reeb {
namespace {

bool has_one_arc(const PathGraph::Node& node) { return node.degree() == 1; }

}  // namespace

void NearNoise::set_threshold(PathGraph& graph, double below) {
  noise_below_ = below;
  if (noise_below_ <= noticed_below_) return;
  noticed_below_ = kNoiseAhead * noise_below_;
  for (PathGraph::Index n = 0; n < graph.nodes.size(); ++n) graph.nodes[n].far_down = graph.nodes[n].far_up = false;
  for (PathGraph::Index a = 0; a < graph.arcs.size(); ++a)
    if (!graph.arcs[a].is_free()) notice(graph, a);
}

// An arc becomes that of a leaf when its end is contracted, since the end has lost all its arcs in that direction but
// one. What is removed as noise reaches less far than what stays. So where a path leads far beyond the end, the arc
// that this makes is long. Nor is an arc ever removed if another one at its ends was written out.
void NearNoise::notice(PathGraph& graph, PathGraph::Index a) const {
  if (noticed_below_ == 0 || !graph.arcs[a].beads.empty()) return;
  PathGraph::Node &lo = graph.nodes[graph.arcs[a].lo()], &hi = graph.nodes[graph.arcs[a].hi()];
  if (!lo.intact || !hi.intact) return;
  const bool of_leaf = has_one_arc(lo) || has_one_arc(hi);
  if (!of_leaf && lo.far_down && hi.far_up) return;
  if (graph.length(a) < (of_leaf ? noticed_below_ : noise_below_)) lo.near_noise = hi.near_noise = true;
}

void NearNoise::notice_at(PathGraph& graph, PathGraph::Index n) const {
  const PathGraph::Node& node = graph.nodes[n];
  if (has_one_arc(node)) notice(graph, node.first(node.degree(kUp) == 1 ? kUp : kDown));
}

void NearNoise::save(StateWriter& out) const {
  out.put(noise_below_);
  out.put(noticed_below_);
}

void NearNoise::restore(StateReader& in) {
  in.get(noise_below_);
  in.get(noticed_below_);
}

bool is_leaf(const PathGraph::Node& n) {
  return n.intact && has_one_arc(n) && n.referenced_arcs == 0 && n.state != PathGraph::State::kIncomplete;
}

bool find_path_beyond(const PathGraph& graph, PathGraph::Index from, PathGraph::Index leaf, Direction d,
                      std::vector<PathGraph::Index>& path) {
  using Index = PathGraph::Index;
  struct Seen {
    Index node, by_arc;
    std::size_t before;
  };
  constexpr std::size_t kNodesExamined = 16;
  std::array<Seen, kNodesExamined> seen;
  std::size_t count = 0;
  seen[count++] = {from, PathGraph::kNone, 0};
  for (std::size_t i = 0; i < count; ++i)
    for (Index a = graph.nodes[seen[i].node].first(d); a != PathGraph::kNone; a = graph.arcs[a].next(d)) {
      const Index end = graph.arcs[a].end[d];
      if (end == leaf) continue;
      const SweepKey &key = graph.nodes[end].key, &limit = graph.nodes[leaf].key;
      if (d == kUp ? limit < key : key < limit) {
        path.assign(1, a);
        for (std::size_t at = i; at != 0; at = seen[at].before) path.push_back(seen[at].by_arc);
        std::reverse(path.begin(), path.end());
        return true;
      }
      if (count == kNodesExamined) return false;
      seen[count++] = {end, a, i};
    }
  return false;
}

}  // namespace reeb
