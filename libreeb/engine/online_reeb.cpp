#include "libreeb/engine/online_reeb.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/value_range.h"
#include "libreeb/engine/chunk_sweep.h"
#include "libreeb/engine/glue.h"
#include "libreeb/engine/stream_chunker.h"
#include "libreeb/graph/bucket.h"

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

  void flush_full_batch() {
    if (chunker_.chunk_size() >= options_.batch_triangles) flush();
  }
  void flush() {
    if (chunker_.chunk_size() == 0) return;
    chunker_.take(batch_, values_);
    sweep_.run(batch_, values_[0], fragment_, sweep_options());
    glue_.add(fragment_);
  }
  ReebGraph snapshot() {
    flush();
    std::vector<ArcKeys> arcs = kept_.arcs();
    std::vector<SweepKey> nodes = kept_.nodes();
    glue_.graph().snapshot(arcs, nodes);
    chunker_.for_each_unused([&](std::span<const double> value, VertexId v) { nodes.push_back({value[0], v}); });
    return make_graph(std::move(arcs), std::move(nodes));
  }
  std::uint64_t removed_pairs() const { return glue_.removed_pairs(); }
  void finish() {
    finished_ = true;
    chunker_.finalize_all();
    flush();
  }

 private:
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
  ValueRange range_;  // of the values so far
  StreamChunker chunker_;
  KeepingSink kept_;
  ChunkSweep sweep_;
  Glue glue_;
  Chunk batch_;
  std::vector<std::vector<double>> values_;
  Fragment fragment_;
};

OnlineReeb::OnlineReeb() : OnlineReeb(Options{}) {}
OnlineReeb::OnlineReeb(Options options, GraphSink* sink) : impl_(std::make_unique<Impl>(options, sink)) {}
OnlineReeb::~OnlineReeb() = default;
OnlineReeb::OnlineReeb(OnlineReeb&&) noexcept = default;
OnlineReeb& OnlineReeb::operator=(OnlineReeb&&) noexcept = default;

VertexId OnlineReeb::add_vertex(double value, const Point& position) {
  const VertexId v = impl_->chunker().add_vertex({&value, 1}, position);
  impl_->flush_full_batch();
  return v;
}
void OnlineReeb::add_simplex(std::span<const VertexId> corners) {
  impl_->chunker().add_simplex(corners);
  impl_->flush_full_batch();
}
void OnlineReeb::finalize(VertexId v) {
  impl_->chunker().finalize(v);
  impl_->flush_full_batch();
}
ReebGraph OnlineReeb::snapshot() { return impl_->snapshot(); }
std::uint64_t OnlineReeb::removed_pairs() const { return impl_->removed_pairs(); }
void OnlineReeb::finish() { impl_->finish(); }

}  // namespace reeb
