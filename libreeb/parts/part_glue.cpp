#include "libreeb/parts/part_glue.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb {

void PartGlue::add(OpenPart& part, const std::vector<PartSpan>& runs) {
  for (const PartSpan& run : runs) have_.add(run);
  merge_spans(part);
  mark_uses(part);
  sort_steps(part.live);
  if (options_.bucket_exponent) {
    coarsen_buckets(part.live, *options_.bucket_exponent);
  } else {
    part.live.bucket_begin.clear();
    part.live.buckets.clear();
  }
  part.live.options = options_;
  glue_.add(part.live);
  remember(part);
  complete_others();
}

// Both sides are right, so the shares that both name are.
void PartGlue::merge_spans(OpenPart& part) const {
  for (std::size_t n = 0; n < part.live.nodes.size(); ++n) {
    if (part.live.nodes[n].uses == kUsedHereOnly) continue;
    const std::uint32_t known = open_of_.find(part.live.nodes[n].key.vertex.value());
    if (known == FlatMap::kNone) continue;
    PartSpan& span = part.spans[n];
    span = {std::max(span.first, open_[known].span.first), std::min(span.last, open_[known].span.last)};
    if (span.first > span.last) throw input_changed();
  }
}

void PartGlue::mark_uses(OpenPart& part) {
  for (std::size_t n = 0; n < part.live.nodes.size(); ++n) {
    Fragment::Node& node = part.live.nodes[n];
    if (node.uses == kUsedHereOnly) continue;
    node.uses = have_.contains(part.spans[n]) ? kUsedEarlier : kUsedEarlier | kUsedLater;
  }
}

// Vertices come in the order of the mesh, about: so edges are zipped in the order of their later vertex, and each
// vertex is completed right after its last edge, which keeps paths short.
void PartGlue::sort_steps(Fragment& live) {
  const auto vertex = [&](FragmentNode n) { return live.nodes[n.value()].key.vertex; };
  const auto place = [&](std::uint32_t e) {
    const VertexId a = vertex(live.edges[e].lo), b = vertex(live.edges[e].hi);
    return std::pair(std::max(a, b), std::min(a, b));
  };
  edge_order_.resize(live.edges.size());
  std::iota(edge_order_.begin(), edge_order_.end(), 0u);
  std::ranges::sort(edge_order_, {}, place);
  last_place_.assign(live.nodes.size(), 0);
  for (std::uint32_t i = 0; i < edge_order_.size(); ++i) {
    const auto [lo, hi] = live.edges[edge_order_[i]];
    last_place_[lo.value()] = last_place_[hi.value()] = i;
  }
  live.steps.clear();
  for (std::uint32_t i = 0; i < edge_order_.size(); ++i) live.steps.push_back({i, edge_order_[i], false});
  for (std::uint32_t n = 0; n < live.nodes.size(); ++n)
    if (live.nodes[n].uses == kUsedEarlier) live.steps.push_back({last_place_[n], n, true});
  std::ranges::sort(live.steps, {},
                    [](const Fragment::Step& step) { return std::tuple(step.place, step.completes, step.index); });
}

void PartGlue::remember(const OpenPart& part) {
  for (std::size_t n = 0; n < part.live.nodes.size(); ++n) {
    const Fragment::Node& node = part.live.nodes[n];
    if ((node.uses & kUsedLater) == 0) continue;
    const auto next = static_cast<std::uint32_t>(open_.size());
    const std::uint32_t index = open_of_.find_or_insert(node.key.vertex.value(), next);
    if (index == next)
      open_.push_back({node.key.vertex, part.spans[n]});
    else
      open_[index].span = part.spans[n];
  }
}

// Vertices that are complete now, whether the shares that came last have them or not.
void PartGlue::complete_others() {
  std::uint32_t kept = 0;
  for (const OpenVertex& open : open_) {
    if (have_.contains(open.span))
      glue_.complete(open.vertex);
    else
      open_[kept++] = open;
  }
  if (kept == open_.size()) return;
  open_.resize(kept);
  open_of_.clear();
  for (std::uint32_t i = 0; i < kept; ++i) open_of_.find_or_insert(open_[i].vertex.value(), i);
}

void PartGlue::copy_open(OpenPart& part) const {
  glue_.copy_live(part.live);
  part.live.options = options_;
  part.live.removed_pairs = static_cast<std::size_t>(removed_pairs());
  part.spans.assign(part.live.nodes.size(), {});
  for (std::size_t n = 0; n < part.live.nodes.size(); ++n)
    if (part.live.nodes[n].uses != kUsedHereOnly)
      part.spans[n] = open_[open_of_.find(part.live.nodes[n].key.vertex.value())].span;
}

std::size_t PartGlue::copy_bytes() const { return glue_.copy_bytes() + glue_.graph().node_count() * sizeof(PartSpan); }

std::size_t PartGlue::memory_bytes() const {
  return glue_.memory_bytes() + open_of_.memory_bytes() + open_.capacity() * sizeof(OpenVertex) +
         4 * (edge_order_.capacity() + last_place_.capacity());
}

std::size_t PartGlue::memory_bytes_with(const OpenPart& part) const {
  constexpr std::size_t kPerNode = sizeof(OpenVertex) + 24 + 4 + sizeof(Fragment::Step),
                        kPerEdge = 4 + sizeof(Fragment::Step);
  return memory_bytes() - glue_.memory_bytes() + glue_.memory_bytes_with(part.live) + part.live.memory_bytes() +
         part.live.nodes.size() * kPerNode + part.live.edges.size() * kPerEdge;
}

}  // namespace reeb
