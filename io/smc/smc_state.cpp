#include "io/smc/smc_state.h"

namespace reeb::io {

SmcModels::SmcModels(unsigned version)
    : operation(kSmcOperations, AdaptiveModel(4, kSmallModel)),
      old_corners(version == 1 ? 4 : 5, kSmallModel),
      start_cache(3, AdaptiveModel(kStartEscape + 1, kSmallModel)),
      edge_cache(kSmcOperations, AdaptiveModel(kEdgeEscape + 1, kSmallModel)),
      pair_cache(kSmcOperations, AdaptiveModel(kPairEscape + 1, kSmallModel)),
      finals_(std::size_t{4} * kMaxUses, AdaptiveModel(2, kSmallModel)) {}

std::uint32_t NumberLists::take(std::uint32_t log_capacity) {
  auto& free = free_[log_capacity];
  if (!free.empty()) {
    const std::uint32_t begin = free.back();
    free.pop_back();
    return begin;
  }
  const auto begin = static_cast<std::uint32_t>(numbers_.size());
  numbers_.resize(numbers_.size() + (std::size_t{1} << log_capacity));
  return begin;
}

void NumberLists::grow(List& list) {
  const std::uint32_t log_capacity = list.begin == kNone ? kFirstLog : list.log_capacity + 1;
  const std::uint32_t begin = take(log_capacity);
  for (std::uint32_t i = 0; i < list.size; ++i) numbers_[begin + i] = numbers_[list.begin + i];
  const std::uint32_t size = list.size;
  release(list);
  list = {begin, size, log_capacity};
}

void NumberLists::release(List& list) {
  if (list.begin != kNone) free_[list.log_capacity].push_back(list.begin);
  list = {};
}

std::uint32_t SmcState::create_vertex(std::uint32_t index, const CodedPosition& position) {
  std::uint32_t slot = static_cast<std::uint32_t>(vertices_.size());
  if (free_vertices_.empty()) {
    vertices_.emplace_back();
  } else {
    slot = free_vertices_.back();
    free_vertices_.pop_back();
  }
  vertices_[slot] = {index, kNone, 0, {}, position};
  return slot;
}

void SmcState::release(std::uint32_t slot) {
  lists_.release(vertices_[slot].edges);
  vertices_[slot].index = kNone;
  free_vertices_.push_back(slot);
}

void SmcState::grow_active() {
  std::vector<std::uint32_t> larger(std::max<std::size_t>(64, 2 * active_.size()));
  for (std::uint32_t i = 0; i < active_count_; ++i) larger[(first_place_ + i) & (larger.size() - 1)] = active_at(i);
  active_.swap(larger);
}

void SmcState::append_active(std::uint32_t slot) {
  if (active_count_ == active_.size()) grow_active();
  vertices_[slot].place = first_place_ + active_count_;
  active_[vertices_[slot].place & (active_.size() - 1)] = slot;
  ++active_count_;
}

// The first vertex of the order moves to the position of the removed one.
void SmcState::remove_active(std::uint32_t slot) {
  const std::uint32_t first = active_at(0), place = vertices_[slot].place;
  active_[place & (active_.size() - 1)] = first;
  vertices_[first].place = place;
  ++first_place_;
  --active_count_;
}

void SmcState::finalize(std::uint32_t slot) {
  remove_active(slot);
  NumberLists::List& own = vertices_[slot].edges;
  for (std::uint32_t i = 0; i < own.size; ++i) {
    const std::uint32_t id = lists_.at(own, i);
    const std::uint32_t other = edges_[id].origin == slot ? edges_[id].target : edges_[id].origin;
    lists_.remove(vertices_[other].edges, id);
    free_edges_.push_back(id);
    --open_edges_;
  }
  release(slot);
}

void SmcState::open_edge(std::uint32_t origin, std::uint32_t target, const CodedPosition& apex) {
  std::uint32_t id = static_cast<std::uint32_t>(edges_.size());
  if (free_edges_.empty()) {
    edges_.emplace_back();
  } else {
    id = free_edges_.back();
    free_edges_.pop_back();
  }
  edges_[id] = {origin, target, apex};
  lists_.append(vertices_[origin].edges, id);
  lists_.append(vertices_[target].edges, id);
  ++open_edges_;
}

void SmcState::close_edge(std::uint32_t id) {
  lists_.remove(vertices_[edges_[id].origin].edges, id);
  lists_.remove(vertices_[edges_[id].target].edges, id);
  free_edges_.push_back(id);
  --open_edges_;
}

void SmcState::apply(const Triangle& triangle, SmcOperation operation) {
  const auto& corners = triangle.corners;
  previous_ = operation;
  for (std::size_t i = 0; i < 3; ++i) {
    cache_[i] = {corners[i], vertices_[corners[i]].index};
    ++vertices_[corners[i]].uses;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t next = corners[(i + 1) % 3], across = corners[(i + 2) % 3];
    if (triangle.edges[i] == kNone)
      open_edge(corners[i], next, vertices_[across].position);
    else
      close_edge(triangle.edges[i]);
  }
}

std::uint32_t SmcState::count_edges(std::uint32_t slot, bool incoming) const {
  const NumberLists::List& list = vertices_[slot].edges;
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < list.size; ++i) {
    const SmcEdge& e = edges_[lists_.at(list, i)];
    count += (incoming ? e.target : e.origin) == slot;
  }
  return count;
}

std::uint32_t SmcState::pick_edge(std::uint32_t slot, bool incoming, std::uint32_t rank) const {
  const NumberLists::List& list = vertices_[slot].edges;
  for (std::uint32_t i = 0; i < list.size; ++i) {
    const std::uint32_t id = lists_.at(list, i);
    if ((incoming ? edges_[id].target : edges_[id].origin) == slot && rank-- == 0) return id;
  }
  return kNone;
}

std::uint32_t SmcState::rank_of_edge(std::uint32_t slot, bool incoming, std::uint32_t edge) const {
  std::uint32_t rank = 0;
  for (std::uint32_t i = 0; edge_at(slot, i) != edge; ++i) {
    const SmcEdge& e = edges_[edge_at(slot, i)];
    rank += (incoming ? e.target : e.origin) == slot;
  }
  return rank;
}

std::uint32_t SmcState::find_edge_from(std::uint32_t slot, std::uint32_t end) const {
  const NumberLists::List& list = vertices_[slot].edges;
  for (std::uint32_t i = 0; i < list.size; ++i)
    if (edges_[lists_.at(list, i)].origin == end) return lists_.at(list, i);
  return kNone;
}

std::uint32_t SmcState::find_edge_to(std::uint32_t slot, std::uint32_t end) const {
  const NumberLists::List& list = vertices_[slot].edges;
  for (std::uint32_t i = 0; i < list.size; ++i)
    if (edges_[lists_.at(list, i)].target == end) return lists_.at(list, i);
  return kNone;
}

std::uint64_t NumberLists::memory_bytes() const {
  std::uint64_t count = numbers_.capacity();
  for (const auto& lists : free_) count += lists.capacity();
  return count * sizeof(std::uint32_t);
}

std::uint64_t SmcState::memory_bytes() const {
  return lists_.memory_bytes() + vertices_.capacity() * sizeof(SmcVertex) + edges_.capacity() * sizeof(SmcEdge) +
         (free_vertices_.capacity() + free_edges_.capacity() + active_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace reeb::io
