#include "libreeb/parts/open_part.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libreeb/base/state_stream.h"
#include "libreeb/containers/flat_map.h"

namespace reeb {
namespace {

void require(bool sound) {
  if (!sound) throw DamagedState();
}

bool is_open(const Fragment::Node& node) { return node.uses != kUsedHereOnly; }

void check_nodes(const OpenPart& part, std::uint32_t parts) {
  const Fragment& live = part.live;
  require(part.spans.size() == live.nodes.size() && live.positions.size() == live.nodes.size());
  FlatMap seen;
  for (std::uint32_t n = 0; n < live.nodes.size(); ++n) {
    const Fragment::Node& node = live.nodes[n];
    require(std::isfinite(node.key.value) && !(std::signbit(node.key.value) && node.key.value == 0));
    require(node.uses == kUsedHereOnly || (node.uses == kUsedLater && !node.settled));
    require(seen.find_or_insert(node.key.vertex.value(), n) == n);
    if (is_open(node)) require(part.spans[n].first <= part.spans[n].last && part.spans[n].last < parts);
  }
}

void check_arcs(const Fragment& live) {
  const std::size_t nodes = live.nodes.size();
  for (const auto& [lo, hi] : live.arcs)
    require(lo.value() < nodes && hi.value() < nodes && live.nodes[lo.value()].key < live.nodes[hi.value()].key);
  if (live.bucket_begin.empty()) return require(live.buckets.empty());
  require(live.bucket_begin.size() == live.arcs.size() + 1 && live.bucket_begin.front() == 0 &&
          live.bucket_begin.back() == live.buckets.size() && std::ranges::is_sorted(live.bucket_begin));
  for (std::size_t a = 0; a < live.arcs.size(); ++a)
    for (std::size_t b = live.bucket_begin[a]; b < live.bucket_begin[a + 1]; ++b)
      require(live.buckets[b].count != 0 &&
              (b == live.bucket_begin[a] || live.buckets[b - 1].index < live.buckets[b].index));
}

void check_paths(const Fragment& live) {
  require(live.path_begin.size() == live.edges.size() + 1 && live.path_begin.front() == 0 &&
          live.path_begin.back() == live.path_arcs.size() && std::ranges::is_sorted(live.path_begin));
  std::vector<std::pair<FragmentNode, FragmentNode>> edges;
  edges.reserve(live.edges.size());
  for (std::size_t e = 0; e < live.edges.size(); ++e) {
    const auto [lo, hi] = live.edges[e];
    require(lo.value() < live.nodes.size() && hi.value() < live.nodes.size());
    require(is_open(live.nodes[lo.value()]) && is_open(live.nodes[hi.value()]));
    FragmentNode at = hi;
    for (std::size_t i = live.path_begin[e]; i < live.path_begin[e + 1]; ++i) {
      require(live.path_arcs[i].value() < live.arcs.size());
      const Fragment::Arc& arc = live.arcs[live.path_arcs[i].value()];
      require(arc.hi == at);
      at = arc.lo;
    }
    require(at == lo && lo != hi);
    edges.emplace_back(lo, hi);
  }
  std::ranges::sort(edges);
  require(std::ranges::adjacent_find(edges) == edges.end());
}

}  // namespace

std::uint64_t open_vertices_of(const OpenPart& part) {
  return static_cast<std::uint64_t>(std::ranges::count_if(part.live.nodes, is_open));
}

void check_open_part(const OpenPart& part, std::uint32_t parts) {
  check_nodes(part, parts);
  check_arcs(part.live);
  check_paths(part.live);
  require(part.live.steps.empty());
}

void coarsen_buckets(Fragment& fragment, int exponent) {
  const int levels = exponent - fragment.options.bucket_exponent.value_or(exponent);
  fragment.options.bucket_exponent = exponent;
  if (levels == 0 || fragment.bucket_begin.empty()) return;
  std::size_t kept = 0, first = 0;
  for (std::size_t a = 0; a + 1 < fragment.bucket_begin.size(); ++a) {
    const std::size_t end = fragment.bucket_begin[a + 1], begin = kept;
    for (std::size_t b = first; b < end; ++b) {
      BucketSum bucket = fragment.buckets[b];
      bucket.index = levels < 64 ? bucket.index >> levels : (bucket.index < 0 ? -1 : 0);
      if (kept != begin && fragment.buckets[kept - 1].index == bucket.index)
        fragment.buckets[kept - 1].add(bucket);
      else
        fragment.buckets[kept++] = bucket;
    }
    first = end;
    fragment.bucket_begin[a + 1] = static_cast<std::uint32_t>(kept);
  }
  fragment.buckets.resize(kept);
}

}  // namespace reeb
