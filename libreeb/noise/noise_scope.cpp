#include "libreeb/noise/noise_scope.h"

#include <array>
#include <cstdint>
#include <span>

#include "libreeb/graph/direction.h"

namespace reeb {
namespace {

class NoiseScope {
 public:
  NoiseScope(const ReebGraph& graph, const Degrees& degrees)
      : graph_(graph), degrees_(degrees), firm_(graph.node_count()), in_scope_(graph.node_count()) {
    for (std::uint32_t node = 0; node < firm_.size(); ++node) firm_[node] = {degree(node, kDown), degree(node, kUp)};
    for (const Direction d : {kDown, kUp}) {
      loose_[d].resize(graph.arc_count());
      passed_on_[d].resize(graph.node_count());
      index_arcs(d);
    }
  }

  std::vector<bool> find() {
    find_loose_arcs();
    for (const Direction d : {kDown, kUp}) {
      keep_chains_from_forks(d);
      add_paths(d);
    }
    return std::move(in_scope_);
  }

 private:
  std::uint32_t degree(std::uint32_t node, Direction d) const { return (d == kUp ? degrees_.up : degrees_.down)[node]; }
  std::uint32_t end(std::uint32_t arc, Direction d) const { return (d == kUp ? graph_.hi : graph_.lo)[arc].value(); }
  bool is_extremum(std::uint32_t node, Direction d) const { return degree(node, d) == 0; }
  bool can_be_contracted(std::uint32_t node) const { return firm_[node][kDown] <= 1 && firm_[node][kUp] <= 1; }

  // The short arcs of a node in direction d.
  std::span<const std::uint32_t> arcs(std::uint32_t node, Direction d) const {
    return std::span(arcs_[d]).subspan(first_[d][node], first_[d][node + 1] - first_[d][node]);
  }

  void index_arcs(Direction d) {
    const auto count = static_cast<std::uint32_t>(graph_.arc_count());
    first_[d].resize(graph_.node_count() + 1);
    arcs_[d].resize(count);
    for (std::uint32_t arc = 0; arc < count; ++arc) ++first_[d][end(arc, opposite(d))];
    std::uint32_t sum = 0;
    for (std::uint32_t& first : first_[d]) first = sum += first;
    for (std::uint32_t arc = count; arc-- > 0;) arcs_[d][--first_[d][end(arc, opposite(d))]] = arc;
  }

  template <class Visit>
  void for_nodes_along(Direction d, const Visit& visit) const {
    const auto count = static_cast<std::uint32_t>(graph_.node_count());
    for (std::uint32_t i = 0; i < count; ++i) visit(d == kUp ? i : count - 1 - i);
  }

  void find_loose_arcs() {
    for (std::uint32_t arc = 0; arc < graph_.arc_count(); ++arc)
      for (const Direction d : {kDown, kUp})
        if (is_extremum(end(arc, d), d)) loosen(arc, d);
    while (!changed_.empty()) {
      const std::uint32_t node = changed_.back();
      changed_.pop_back();
      if (!can_be_contracted(node)) continue;
      for (const Direction d : {kDown, kUp})
        if (firm_[node][d] < degree(node, d)) pass_on(node, d);
    }
  }

  // The arc of a leaf in direction d might begin with this arc.
  void loosen(std::uint32_t arc, Direction d) {
    if (loose_[d][arc]) return;
    loose_[d][arc] = true;
    const std::uint32_t saddle = end(arc, opposite(d));
    --firm_[saddle][d];
    changed_.push_back(saddle);
  }

  // A loose arc continues from this node in direction d, so the arcs before the node are loose too.
  void pass_on(std::uint32_t node, Direction d) {
    if (passed_on_[d][node]) return;
    passed_on_[d][node] = true;
    for (const std::uint32_t arc : arcs(node, opposite(d))) loosen(arc, d);
  }

  // A leaf is removed only if its saddle has another arc in its direction. Arcs on no chain from such a saddle are not
  // loose after all.
  void keep_chains_from_forks(Direction d) {
    std::vector<bool> continues(graph_.node_count());
    for_nodes_along(d, [&](std::uint32_t node) {
      const bool begins = degree(node, d) > 1 || continues[node];
      for (const std::uint32_t arc : arcs(node, d)) {
        if (!loose_[d][arc]) continue;
        const std::uint32_t next = end(arc, d);
        if (!begins) {
          loose_[d][arc] = false;
          continue;
        }
        in_scope_[node] = in_scope_[next] = true;
        if (can_be_contracted(next)) continues[next] = true;
      }
    });
  }

  // Adds the nodes on paths in direction d from the starts of loose arcs, up to the farthest leaf there.
  void add_paths(Direction d) {
    std::vector<std::uint32_t> farthest(graph_.node_count());
    for_nodes_along(opposite(d), [&](std::uint32_t node) {
      farthest[node] = node;
      for (const std::uint32_t arc : arcs(node, d))
        if (loose_[d][arc]) extend(farthest[node], d, farthest[end(arc, d)]);
    });
    for_nodes_along(d, [&](std::uint32_t node) {
      for (const std::uint32_t arc : arcs(node, d)) {
        const std::uint32_t next = end(arc, d);
        if (along(d, next) >= along(d, farthest[node])) continue;
        in_scope_[next] = true;
        extend(farthest[next], d, farthest[node]);
      }
    });
  }
  static void extend(std::uint32_t& node, Direction d, std::uint32_t to) {
    if (along(d, to) > along(d, node)) node = to;
  }

  const ReebGraph& graph_;
  const Degrees& degrees_;
  std::array<std::vector<std::uint32_t>, 2> first_, arcs_;
  std::vector<std::array<std::uint32_t, 2>> firm_;  // arcs of the whole graph that are not loose
  std::array<std::vector<bool>, 2> loose_;          // by arc
  std::array<std::vector<bool>, 2> passed_on_;      // by node
  std::vector<bool> in_scope_;
  std::vector<std::uint32_t> changed_;  // nodes that lost a firm arc
};

}  // namespace

std::vector<bool> noise_scope(const ReebGraph& short_arcs, const Degrees& degrees) {
  return NoiseScope(short_arcs, degrees).find();
}

}  // namespace reeb
