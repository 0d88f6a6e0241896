#include "libreeb/grid/box_sweep.h"

#include <algorithm>

namespace reeb {
namespace {

constexpr std::uint32_t kNone = ContourTree::kNone;

}  // namespace

void BoxSweep::run(const Chunk& chunk, std::span<const double> values, Fragment& fragment,
                   const SweepOptions& options) {
  ranks_.sort(values, chunk.ids);
  tree_.build(chunk.box, ranks_.order());
  find_face_arcs(chunk, values);

  const auto n = static_cast<std::uint32_t>(chunk.vertex_count());
  const SweptChunk swept{chunk, values, ranks_.order(), nullptr};
  builder_.start(n, options);
  arc_of_.resize(n);
  node_of_.resize(n);
  passed_.clear();
  // One bucket after the other if there is an embedding, else all vertices at once.
  for (std::uint32_t v = 0, end = n; v < n; end = n) {
    if (options.bucket_exponent) {
      const std::int64_t index = bucket_index(swept.value(VertexRank(v)), *options.bucket_exponent);
      end = swept.end_of_bucket(v, index, *options.bucket_exponent);
      builder_.start_bucket(index);
    }
    while (v < end) visit(swept, v++, options.bucket_exponent.has_value());
  }
  add_paths();
  builder_.finish(swept, shared_, fragment);
  add_passed(chunk, values, fragment);
}

// ---- faces

void BoxSweep::find_face_arcs(const Chunk& chunk, std::span<const double> values) {
  face_arcs_.clear();
  ends_face_arc_.assign(chunk.vertex_count(), 0);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true})
      if ((chunk.shared_faces >> (2 * axis + (high ? 1 : 0)) & 1) != 0) take_face(chunk, values, axis, high);
  // Faces that meet can have an arc in common. Its path in the tree of the box is the same.
  std::sort(face_arcs_.begin(), face_arcs_.end());
  face_arcs_.erase(std::unique(face_arcs_.begin(), face_arcs_.end()), face_arcs_.end());
}

// Its vertices are in the order of the box, so ties are settled as there.
void BoxSweep::take_face(const Chunk& chunk, std::span<const double> values, std::size_t axis, bool high) {
  BoxSize size = chunk.box;
  const std::array<std::uint32_t, 3> step{1, size[0], size[0] * size[1]};
  const std::uint32_t first = high ? (size[axis] - 1) * step[axis] : 0;
  size[axis] = 1;
  face_vertices_.clear();
  for (std::uint32_t k = 0; k < size[2]; ++k)
    for (std::uint32_t j = 0; j < size[1]; ++j)
      for (std::uint32_t i = 0; i < size[0]; ++i)
        face_vertices_.push_back(first + i * step[0] + j * step[1] + k * step[2]);
  const auto n = static_cast<std::uint32_t>(face_vertices_.size());
  face_values_.resize(n);
  face_ids_.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) {
    face_values_[i] = values[face_vertices_[i]];
    face_ids_[i] = chunk.ids[face_vertices_[i]];
  }
  face_ranks_.sort(face_values_, face_ids_);
  const auto order = face_ranks_.order();
  face_tree_.build(size, order);
  lower_end_.resize(n);
  for (std::uint32_t v = 0; v < n; ++v) {
    const std::uint32_t here = face_vertices_[order[v]];
    std::uint32_t start = here;
    if (face_tree_.is_regular(v)) {
      face_tree_.for_each_down(v, [&](std::uint32_t e) { start = lower_end_[e]; });
    } else {
      ends_face_arc_[here] = 1;
      face_tree_.for_each_down(v, [&](std::uint32_t e) { face_arcs_.push_back({lower_end_[e], here}); });
    }
    face_tree_.for_each_up(v, [&](std::uint32_t e) { lower_end_[e] = start; });
  }
}

// ---- the tree of the box, from below

void BoxSweep::visit(const SweptChunk& swept, std::uint32_t v, bool embeds) {
  const LocalVertex local = swept.local(VertexRank(v));
  if (tree_.is_regular(v) && ends_face_arc_[local.value()] == 0) {
    SweepArc arc;
    tree_.for_each_down(v, [&](std::uint32_t e) { arc = arc_of_[e]; });
    tree_.for_each_up(v, [&](std::uint32_t e) { arc_of_[e] = arc; });
    const std::uint8_t uses = swept.chunk.uses[local.value()];
    if (uses == kUsedHereOnly) {
      if (embeds) builder_.add_regular(arc, local);
    } else if (uses == kUsedEarlier) {
      passed_.emplace_back(local, arc);
    }
    return;
  }
  const SweepNode node = builder_.add_node(VertexRank(v));
  node_of_[local.value()] = node;
  SweepArc last;
  tree_.for_each_down(v, [&](std::uint32_t e) { builder_.end_arc(last = arc_of_[e], node); });
  tree_.for_each_up(v, [&](std::uint32_t e) { arc_of_[e] = last = builder_.add_arc(node); });
  if (tree_.degree_up(v) != 0) builder_.set_main_branch(node, last);
  if (tree_.degree_up(v) + tree_.degree_down(v) == 1) builder_.note_leaf(node, last);
}

// ---- paths

// Every node gets its way to the last one.
void BoxSweep::place_nodes() {
  const SweepGraph& graph = builder_.graph();
  const auto nodes = static_cast<std::uint32_t>(graph.nodes.size());
  const auto arcs = static_cast<std::uint32_t>(graph.arcs.size());
  first_down_.assign(nodes, kNone);
  next_down_.resize(arcs);
  for (std::uint32_t a = 0; a < arcs; ++a)
    next_down_[a] = std::exchange(first_down_[graph.arcs[SweepArc(a)].hi.value()], a);
  // Arcs are numbered by lower node, so those up from a node are consecutive.
  std::vector<std::uint32_t>& first_up = arcs_from_;
  first_up.assign(nodes + 1, arcs);
  for (std::uint32_t a = arcs; a-- > 0;) first_up[graph.arcs[SweepArc(a)].lo.value()] = a;
  for (std::uint32_t n = nodes; n-- > 0;) first_up[n] = std::min(first_up[n], first_up[n + 1]);

  places_.resize(nodes);
  queue_.clear();
  const SweepNode root(nodes - 1);
  places_[root.value()] = {SweepArc::none(), SweepNode::none(), 0};
  queue_.push_back(root);
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    const SweepNode n = queue_[i];
    const Place here = places_[n.value()];
    const auto enter = [&](std::uint32_t a, SweepNode other) {
      if (SweepArc(a) == here.to_parent) return;
      places_[other.value()] = {SweepArc(a), n, here.depth + 1};
      queue_.push_back(other);
    };
    for (std::uint32_t a = first_down_[n.value()]; a != kNone; a = next_down_[a]) enter(a, graph.arcs[SweepArc(a)].lo);
    for (std::uint32_t a = first_up[n.value()]; a < first_up[n.value() + 1]; ++a) enter(a, graph.arcs[SweepArc(a)].hi);
  }
}

// The path of an arc of a face is the only one between its ends.
void BoxSweep::add_paths() {
  shared_.start(0);
  if (face_arcs_.empty()) return;
  place_nodes();
  const SweepGraph& graph = builder_.graph();
  for (const auto& [lo, hi] : face_arcs_) {
    path_.clear();
    from_above_.clear();
    SweepNode a = node_of_[lo], b = node_of_[hi];
    const VertexRank top = graph.nodes[b].vertex;
    while (a != b) {
      const bool from_below = places_[a.value()].depth >= places_[b.value()].depth;
      SweepNode& end = from_below ? a : b;
      (from_below ? path_ : from_above_).push_back(places_[end.value()].to_parent);
      end = places_[end.value()].parent;
    }
    path_.insert(path_.end(), from_above_.rbegin(), from_above_.rend());
    shared_.add(node_of_[lo], top, path_.front(), top.value());
    for (const SweepArc arc : std::span(path_).subspan(1)) {
      const SweepNode n = graph.arcs[arc].lo;
      if (tree_.degree_up(graph.nodes[n].vertex.value()) > 1) shared_.note_branch(n, arc);
    }
  }
}

void BoxSweep::add_passed(const Chunk& chunk, std::span<const double> values, Fragment& fragment) const {
  for (const auto& [local, arc] : passed_) {
    const std::size_t i = local.value();
    fragment.passed.push_back(
        {chunk.ids[i], builder_.open_arc(arc), values[i], chunk.positions.empty() ? Point{} : chunk.positions[i]});
  }
}

std::size_t BoxSweep::memory_bytes() const {
  return ranks_.memory_bytes() + face_ranks_.memory_bytes() + tree_.memory_bytes() + face_tree_.memory_bytes() +
         builder_.memory_bytes() + shared_.memory_bytes() + face_arcs_.capacity() * sizeof(FaceArc) +
         ends_face_arc_.capacity() + passed_.capacity() * sizeof(passed_[0]) + places_.capacity() * sizeof(Place) +
         8 * (face_values_.capacity() + face_ids_.capacity()) +
         4 * (arc_of_.capacity() + node_of_.capacity() + face_vertices_.capacity() + lower_end_.capacity() +
              first_down_.capacity() + next_down_.capacity() + arcs_from_.capacity() + queue_.capacity() +
              path_.capacity() + from_above_.capacity());
}

}  // namespace reeb
