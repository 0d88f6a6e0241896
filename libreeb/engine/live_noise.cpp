#include "libreeb/engine/live_noise.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace reeb {
namespace {

bool has_one_arc(const PathGraph::Node& node) { return node.degree() == 1; }

}  // namespace

void NearNoise::set_threshold(PathGraph& graph, double below) {
  noise_below_ = below;
  if (noise_below_ <= noticed_below_) return;
  noticed_below_ = 2 * noise_below_;
  for (PathGraph::Index a = 0; a < graph.arcs.size(); ++a)
    if (!graph.arcs[a].is_free()) notice(graph, a);
}

void NearNoise::notice(PathGraph& graph, PathGraph::Index a) const {
  if (noticed_below_ == 0 || !graph.arcs[a].beads.empty()) return;
  PathGraph::Node &lo = graph.nodes[graph.arcs[a].lo()], &hi = graph.nodes[graph.arcs[a].hi()];
  const double below = has_one_arc(lo) || has_one_arc(hi) ? noticed_below_ : noise_below_;
  if (graph.length(a) < below) lo.near_noise = hi.near_noise = true;
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
