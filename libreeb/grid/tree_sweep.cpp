#include "libreeb/grid/tree_sweep.h"

namespace reeb {

void TreeSweep::run(const SweptChunk& swept, const ContourTree& tree, std::span<const Keep> keep,
                    const SweepOptions& options) {
  const auto n = static_cast<std::uint32_t>(swept.order.size());
  embeds_ = options.bucket_exponent.has_value();
  builder_.start(n, options);
  arc_of_.resize(n);
  passed_.clear();
  for (std::uint32_t v = 0; v < n; ++v) visit(swept, tree, v, keep[v]);
  builder_.end_sweep(swept);
}

void TreeSweep::visit(const SweptChunk& swept, const ContourTree& tree, std::uint32_t v, Keep keep) {
  const LocalVertex local = swept.local(VertexRank(v));
  if (keep == kIfNotRegular && tree.is_regular(v)) {
    SweepArc arc;
    tree.for_each_down(v, [&](std::uint32_t e) { arc = arc_of_[e]; });
    tree.for_each_up(v, [&](std::uint32_t e) { arc_of_[e] = arc; });
    const BoxFaces faces = swept.chunk.uses[local.value()];
    if (!embeds_ || (faces & kHighFaces) != 0) return;  // a later box has it
    if (faces == kUsedHereOnly)
      builder_.note_regular(arc, local);
    else
      passed_.emplace_back(local, arc);
    return;
  }
  const SweepNode node = builder_.add_node(VertexRank(v));
  SweepArc last;
  tree.for_each_down(v, [&](std::uint32_t e) { builder_.end_arc(last = arc_of_[e], node); });
  tree.for_each_up(v, [&](std::uint32_t e) { arc_of_[e] = last = builder_.add_arc(node); });
  if (keep == kWithLostArcs)
    builder_.set_lost_arcs(node);
  else if (tree.degree_up(v) + tree.degree_down(v) == 1)
    builder_.note_leaf(node, last);
}

void TreeSweep::finish(const SweptChunk& swept, Fragment& fragment) {
  builder_.finish_tree(swept, fragment);
  for (const auto& [local, arc] : passed_) {
    const std::size_t i = local.value();
    fragment.passed.push_back(
        {swept.chunk.ids[i], builder_.open_arc(arc), swept.values[i], swept.chunk.position(local)});
  }
}

std::size_t TreeSweep::memory_bytes() const {
  return builder_.memory_bytes() + 4 * arc_of_.capacity() + passed_.capacity() * sizeof(passed_[0]);
}

}  // namespace reeb
