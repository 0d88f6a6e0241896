#include "tools/library/snapshots.h"

#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/value_range.h"
#include "libreeb/engine/online_reeb.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tools/library/run_files.h"

namespace reeb {
namespace {

// The graph of one function as far as the stream has come.
class LiveFunction {
 public:
  LiveFunction(VertexFunction& function, const std::string& output, io::Existing existing)
      : function_(function), stem_(snapshot_stem(output)), existing_(existing) {}

  void add_vertices(const MeshBatch& batch) {
    if (batch.vertex_count == 0) return;
    graph_.skip_to(batch.first_vertex);
    ids_.clear();
    for (std::size_t i = 0; i < batch.vertex_count; ++i) ids_.emplace_back(batch.first_vertex.value() + i);
    columns_.clear();
    for (const unsigned k : function_.columns()) columns_.emplace_back(batch.column(k));
    values_.resize(ids_.size());
    function_.evaluate(ids_, columns_, values_);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      range_.add(values_[i]);
      graph_.add_vertex(values_[i]);
    }
  }
  std::uint64_t memory_bytes() const { return graph_.memory_bytes(); }
  void add_simplex(std::span<const VertexId> corners) { graph_.add_simplex(corners); }
  void finalize(VertexId v) { graph_.finalize(v); }

  void write(std::uint64_t number, std::uint64_t vertices, std::uint64_t triangles) {
    ooc::FileMeta meta;
    meta.function = function_.name();
    if (vertices != 0) {
      meta.function_min = range_.min;
      meta.function_max = range_.max;
    }
    meta.mesh_vertices = vertices;
    meta.mesh_triangles = triangles;
    ooc::write_graph_file(snapshot_name(stem_, number), meta, graph_.snapshot(), {}, {.existing = existing_});
  }

  // The first and the last snapshot after this one.
  std::string later_than(std::uint64_t number) const {
    std::vector<std::uint64_t> left = existing_snapshots(stem_);
    std::erase_if(left, [number](std::uint64_t other) { return other <= number; });
    if (left.empty()) return {};
    const std::string first = snapshot_name(stem_, left.front());
    return left.size() == 1 ? first : first + " to " + snapshot_name(stem_, left.back());
  }

 private:
  VertexFunction& function_;
  std::string stem_;
  io::Existing existing_;
  OnlineReeb graph_;
  ValueRange range_;
  std::vector<VertexId> ids_;
  std::vector<std::span<const double>> columns_;
  std::vector<double> values_;
};

class SnapshotReader : public MeshReader {
 public:
  SnapshotReader(std::unique_ptr<MeshReader> reader, std::uint64_t every, std::span<VertexFunction* const> functions,
                 std::span<const std::string> outputs, io::Existing existing)
      : reader_(std::move(reader)), every_(every), next_(every) {
    for (std::size_t f = 0; f < functions.size(); ++f) graphs_.emplace_back(*functions[f], outputs[f], existing);
  }

  const MeshInfo& info() const override { return reader_->info(); }
  std::uint64_t bytes_read() const override { return reader_->bytes_read(); }
  std::uint64_t memory_bytes() const override { return reader_->memory_bytes() + graph_bytes_; }
  std::string memory_hint() const override {
    if (info().finalizes) return reader_->memory_hint();
    return "convert the mesh with reeb convert --finalize first; without finalization, snapshots keep all triangles in "
           "memory";
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> all = reader_->warnings();
    for (const LiveFunction& graph : graphs_)
      if (const std::string left = graph.later_than(number_); !left.empty())
        all.push_back("snapshots of an earlier run are left: " + left);
    return all;
  }

  bool read(MeshBatch& batch) override {
    if (!reader_->read(batch)) return false;
    vertices_ += batch.vertex_count;
    for (LiveFunction& graph : graphs_) graph.add_vertices(batch);
    batch.for_each_simplex([this](std::span<const VertexId> corners) { add_simplex(corners); });
    for (const VertexId v : batch.finalized)
      for (LiveFunction& graph : graphs_) graph.finalize(v);
    count_memory();
    return true;
  }

 private:
  // Counts in steps, since whoever reserves it does so again for each change.
  void count_memory() {
    std::uint64_t bytes = 0;
    for (const LiveFunction& graph : graphs_) bytes += graph.memory_bytes();
    if (bytes > graph_bytes_ || bytes < graph_bytes_ / 2) graph_bytes_ = bytes + bytes / 16;
  }

  void add_simplex(std::span<const VertexId> corners) {
    for (LiveFunction& graph : graphs_) graph.add_simplex(corners);
    triangles_ += corners.size() == 3 ? 1u : 0u;
    if (++simplices_ >= next_) write();
  }

  void write() {
    ++number_;
    for (LiveFunction& graph : graphs_) graph.write(number_, vertices_, triangles_);
    next_ += every_;
  }

  std::unique_ptr<MeshReader> reader_;
  std::uint64_t every_, next_;
  std::vector<LiveFunction> graphs_;
  std::uint64_t number_ = 0, vertices_ = 0, triangles_ = 0, simplices_ = 0, graph_bytes_ = 0;
};

}  // namespace

std::unique_ptr<MeshReader> with_snapshots(std::unique_ptr<MeshReader> reader, std::uint64_t every,
                                           std::span<VertexFunction* const> functions,
                                           std::span<const std::string> outputs, io::Existing existing) {
  return std::make_unique<SnapshotReader>(std::move(reader), every, functions, outputs, existing);
}

}  // namespace reeb
