#include "libreeb/engine/online_reeb.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/flat_map.h"
#include "libreeb/engine/chunk.h"
#include "libreeb/engine/chunk_sweep.h"
#include "libreeb/engine/glue.h"

namespace reeb {
namespace {

// Keeps what is handed over, for users who want the whole graph in memory.
class KeepingSink : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> nodes) override {
    for (const SettledNode& node : nodes) nodes_.push_back(node.key);
  }
  void add_arcs(std::span<const ArcKeys> arcs) override { arcs_.insert(arcs_.end(), arcs.begin(), arcs.end()); }

  const std::vector<SweepKey>& nodes() const { return nodes_; }
  const std::vector<ArcKeys>& arcs() const { return arcs_; }

 private:
  std::vector<SweepKey> nodes_;
  std::vector<ArcKeys> arcs_;
};

}  // namespace

class OnlineReeb::Impl {
 public:
  Impl(Options options, GraphSink* sink)
      : options_(options), glue_(sink != nullptr ? *sink : kept_, sink != nullptr) {}

  VertexId add_vertex(double value, const Point& position);
  void add_simplex(std::span<const VertexId> corners);
  void finalize(VertexId v);
  ReebGraph snapshot();
  void finish();

 private:
  // A vertex that is not final yet.
  struct Active {
    double value;
    Point position;
    std::uint32_t local;  // in the batch, or kNone
  };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  std::uint32_t slot_of(VertexId v, const char* use);
  std::uint32_t bring_in(std::uint32_t slot, VertexId v, std::uint8_t uses);
  void add_triangle(VertexId a, VertexId b, VertexId c);
  void flush();

  Options options_;
  KeepingSink kept_;
  Glue glue_;
  ChunkSweep sweep_;
  Fragment fragment_;
  std::uint64_t next_vertex_ = 0;
  FlatMap slot_of_vertex_;
  std::vector<Active> active_;
  std::vector<std::uint32_t> free_slots_;
  Chunk batch_;
  std::vector<std::uint32_t> slot_of_local_;  // kNone once the vertex is final
  std::vector<VertexId> corners_;
};

std::uint32_t OnlineReeb::Impl::slot_of(VertexId v, const char* use) {
  const std::uint32_t slot = slot_of_vertex_.find(v.value());
  if (slot != FlatMap::kNone) return slot;
  const bool known = v.value() < next_vertex_;
  throw Error(ErrorKind::kBadInput,
              std::string(use) + " vertex " + std::to_string(v.value()) +
                  (known ? ", which was finalized before"
                         : ", but only " + std::to_string(next_vertex_) + " vertices were added"),
              known ? "finalize a vertex once, after the last simplex that uses it"
                    : "add every vertex before the first simplex that uses it");
}

// Gives a vertex a place in the batch.
std::uint32_t OnlineReeb::Impl::bring_in(std::uint32_t slot, VertexId v, std::uint8_t uses) {
  Active& active = active_[slot];
  if (active.local != kNone) return active.local;
  active.local = static_cast<std::uint32_t>(batch_.vertex_count());
  batch_.values.push_back(active.value);
  batch_.ids.push_back(v);
  batch_.positions.push_back(active.position);
  batch_.uses.push_back(uses);
  slot_of_local_.push_back(slot);
  return active.local;
}

VertexId OnlineReeb::Impl::add_vertex(double value, const Point& position) {
  const VertexId v(next_vertex_);
  if (!std::isfinite(value))
    throw Error(ErrorKind::kBadInput, "the value of vertex " + std::to_string(v.value()) + " is not finite",
                "give every vertex a finite function value");
  ++next_vertex_;
  std::uint32_t slot;
  if (free_slots_.empty()) {
    slot = static_cast<std::uint32_t>(active_.size());
    active_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  active_[slot] = {value + 0.0, position, kNone};  // -0.0 becomes 0.0
  slot_of_vertex_.find_or_insert(v.value(), slot);
  bring_in(slot, v, kUsedLater);
  if (batch_.vertex_count() >= options_.batch_triangles) flush();
  return v;
}

void OnlineReeb::Impl::add_simplex(std::span<const VertexId> corners) {
  corners_.assign(corners.begin(), corners.end());
  std::sort(corners_.begin(), corners_.end());
  corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  for (const VertexId v : corners_) slot_of(v, "a simplex names");
  const std::size_t n = corners_.size();
  if (n == 2) add_triangle(corners_[0], corners_[1], corners_[1]);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k) add_triangle(corners_[i], corners_[j], corners_[k]);
}

void OnlineReeb::Impl::add_triangle(VertexId a, VertexId b, VertexId c) {
  for (const VertexId v : {a, b, c})
    batch_.corners.push_back(bring_in(slot_of_vertex_.find(v.value()), v, kUsedEarlier | kUsedLater));
  if (batch_.triangle_count() >= options_.batch_triangles) flush();
}

void OnlineReeb::Impl::finalize(VertexId v) {
  const std::uint32_t slot = slot_of(v, "finalized is");
  const std::uint32_t local = active_[slot].local;
  if (local != kNone) {
    batch_.uses[local] &= static_cast<std::uint8_t>(~kUsedLater);
    slot_of_local_[local] = kNone;
  } else {
    glue_.complete(v);
  }
  slot_of_vertex_.erase(v.value());
  free_slots_.push_back(slot);
}

void OnlineReeb::Impl::flush() {
  if (batch_.vertex_count() == 0) return;
  sweep_.run(batch_, fragment_);
  glue_.add(fragment_);
  for (const std::uint32_t slot : slot_of_local_)
    if (slot != kNone) active_[slot].local = kNone;
  slot_of_local_.clear();
  batch_.clear();
}

ReebGraph OnlineReeb::Impl::snapshot() {
  flush();
  std::vector<ArcKeys> arcs = kept_.arcs();
  std::vector<SweepKey> isolated = kept_.nodes();
  glue_.graph().snapshot(arcs, isolated);
  return make_graph(std::move(arcs), std::move(isolated));
}

void OnlineReeb::Impl::finish() {
  flush();
  glue_.complete_all();
  slot_of_vertex_.clear();
}

OnlineReeb::OnlineReeb() : OnlineReeb(Options{}) {}
OnlineReeb::OnlineReeb(Options options, GraphSink* sink) : impl_(std::make_unique<Impl>(options, sink)) {}
OnlineReeb::~OnlineReeb() = default;
OnlineReeb::OnlineReeb(OnlineReeb&&) noexcept = default;
OnlineReeb& OnlineReeb::operator=(OnlineReeb&&) noexcept = default;

VertexId OnlineReeb::add_vertex(double value, const Point& position) { return impl_->add_vertex(value, position); }
void OnlineReeb::add_simplex(std::span<const VertexId> corners) { impl_->add_simplex(corners); }
void OnlineReeb::finalize(VertexId v) { impl_->finalize(v); }
ReebGraph OnlineReeb::snapshot() { return impl_->snapshot(); }
void OnlineReeb::finish() { impl_->finish(); }

}  // namespace reeb
