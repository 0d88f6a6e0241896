#include "libreeb/engine/online_reeb.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/value_range.h"
#include "libreeb/engine/glue.h"
#include "libreeb/engine/stream_chunker.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/sweep/chunk_sweep.h"

namespace reeb {
namespace {

// Keeps settled nodes and arcs, for users who want the whole graph in memory.
class KeepingSink : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> nodes) override {
    for (const SettledNode& node : nodes) nodes_.push_back(node.key);
  }
  void add_arcs(const SettledArcs& settled) override {
    arcs_.insert(arcs_.end(), settled.arcs.begin(), settled.arcs.end());
  }

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
      : options_(options), chunker_(1, sink != nullptr), glue_(sink != nullptr ? *sink : kept_, sink != nullptr) {}

  // For what adds to the graph.
  // THROWS: Error{kBadInput} after finish().
  StreamChunker& chunker() {
    if (finished_)
      throw Error(ErrorKind::kBadInput, "the on-line graph is finished, so nothing can be added",
                  "call finish() after the last addition, or start another graph");
    return chunker_;
  }

  // To be called after each addition and finalization.
  void advance() {
    ++arrived_;
    const std::size_t most = std::max(options_.batch_triangles, options_.waiting_triangles);
    if (chunker_.chunk_size() >= std::min(most, kMostSwept)) {
      chunker_.take(batch_, values_);
      glue_batch();
    } else if (arrived_ >= options_.batch_triangles && arrived_ >= stayed_ / kStayedPerArrived && is_mostly_final()) {
      chunker_.take_final(batch_, values_);
      glue_batch();
    }
  }

  // As the graph is to stay as it is, what waits is glued to a copy, as if nothing came later. So almost all of it is
  // settled by its sweep.
  ReebGraph snapshot() {
    KeepingSink now;
    std::vector<ArcKeys> arcs = kept_.arcs();
    std::vector<SweepKey> nodes = kept_.nodes();
    if (chunker_.chunk_size() == 0) {
      glue_.graph().snapshot(arcs, nodes);
    } else {
      Glue copy(glue_, now);
      copy.add(swept_chunk());
      copy.graph().snapshot(arcs, nodes);
    }
    arcs.insert(arcs.end(), now.arcs().begin(), now.arcs().end());
    nodes.insert(nodes.end(), now.nodes().begin(), now.nodes().end());
    chunker_.for_each_unused([&](std::span<const double> value, VertexId v) { nodes.push_back({value[0], v}); });
    return make_graph(std::move(arcs), std::move(nodes));
  }
  // Arrays grow to twice their size. What waits is swept at once, and a snapshot has a copy of the live graph.
  std::uint64_t memory_bytes() const {
    constexpr std::uint64_t kPerSimplex = 24 + kSweptSimplex, kPerVertex = 2 * (8 + 1 + 8 + 4) + kSweptVertex;
    constexpr std::uint64_t kPerActiveVertex = 72 + 2 * (4 + 1 + 8 + 8), kPerArc = 6 * sizeof(ArcKeys);
    const Chunk& chunk = chunker_.chunk();
    return (chunk.triangle_count() + kFewSimplices) * kPerSimplex + chunk.vertex_count() * kPerVertex +
           chunker_.active_vertices() * kPerActiveVertex + kept_.arcs().size() * kPerArc + sweep_.memory_bytes() +
           fragment_.memory_bytes() + 2 * glue_.memory_bytes();
  }
  std::uint64_t removed_pairs() const { return glue_.removed_pairs(); }
  void finish() {
    finished_ = true;
    chunker_.finalize_all();
    chunker_.take(batch_, values_);
    glue_batch();
  }

 private:
  // Measured bytes, of the sweep and of its graph: the most, for random functions.
  static constexpr std::uint64_t kSweptSimplex = 120, kSweptVertex = 60, kFewSimplices = 4096;
  static constexpr std::size_t kMostSwept = std::size_t{1} << 30;
  // So the simplices that stay are not gone over too often.
  static constexpr std::size_t kStayedPerArrived = 4;

  // Each vertex that is not final takes its share of the live graph, so it should have triangles that are done.
  bool is_mostly_final() const { return 4 * chunker_.final_in_chunk() >= 3 * chunker_.chunk().vertex_count(); }

  void glue_batch() {
    arrived_ = 0;
    stayed_ = chunker_.chunk_size();
    if (batch_.vertex_count() == 0) return;
    sweep_.run(batch_, values_[0], fragment_, sweep_options());
    glue_.add(fragment_);
  }

  Fragment swept_chunk() {
    ChunkSweep sweep;
    Fragment fragment;
    sweep.run(chunker_.chunk(), chunker_.values()[0], fragment);
    return fragment;
  }

  SweepOptions sweep_options() {
    SweepOptions sweep{.noise_below = options_.noise_below};
    if (options_.buckets != 0 && !values_[0].empty()) {
      for (const double value : values_[0]) range_.add(value);
      sweep.bucket_exponent = bucket_exponent(range_.min, range_.max, options_.buckets);
    }
    return sweep;
  }

  Options options_;
  bool finished_ = false;
  std::size_t arrived_ = 0;  // simplices, vertices and finalizations, since a batch was last glued
  std::size_t stayed_ = 0;   // simplices that stayed in the chunk then
  ValueRange range_;         // of the values so far
  StreamChunker chunker_;
  KeepingSink kept_;
  ChunkSweep sweep_;
  Glue glue_;
  Chunk batch_;
  std::vector<std::vector<double>> values_;
  Fragment fragment_;
};

OnlineReeb::OnlineReeb() : OnlineReeb(Options{}) {}
OnlineReeb::OnlineReeb(Options options, GraphSink* sink) {
  if (!(options.noise_below >= 0))
    throw Error(ErrorKind::kUsage, "noise_below is not a number of 0 or more", "give a threshold like 0.001");
  if (options.buckets > kMostBuckets)
    throw Error(ErrorKind::kUsage, "there can be at most 2^20 buckets", "choose fewer, for instance 64");
  impl_ = std::make_unique<Impl>(options, sink);
}
OnlineReeb::~OnlineReeb() = default;
OnlineReeb::OnlineReeb(OnlineReeb&&) noexcept = default;
OnlineReeb& OnlineReeb::operator=(OnlineReeb&&) noexcept = default;

VertexId OnlineReeb::add_vertex(double value, const Point& position) {
  StreamChunker& chunker = impl_->chunker();
  if (!std::ranges::all_of(position, [](double coordinate) { return std::isfinite(coordinate); }))
    throw Error(ErrorKind::kBadInput, "the position of the vertex is not finite", "give every vertex finite numbers");
  const VertexId v = chunker.add_vertex({&value, 1}, position);
  impl_->advance();
  return v;
}
void OnlineReeb::skip_to(VertexId next) { impl_->chunker().skip_to(next); }
void OnlineReeb::add_simplex(std::span<const VertexId> corners) {
  impl_->chunker().add_simplex(corners);
  impl_->advance();
}
void OnlineReeb::finalize(VertexId v) {
  impl_->chunker().finalize(v);
  impl_->advance();
}
ReebGraph OnlineReeb::snapshot() { return impl_->snapshot(); }
std::uint64_t OnlineReeb::memory_bytes() const { return impl_->memory_bytes(); }
std::uint64_t OnlineReeb::removed_pairs() const { return impl_->removed_pairs(); }
void OnlineReeb::finish() { impl_->finish(); }

}  // namespace reeb
