#include "io/streaming/stream_mesh_reader.h"

#include <algorithm>

#include "io/events/pre_order.h"
#include "io/mesh/missing_property.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// Names for the further values of vertices: "s0", "s1", ... for floats, "i0", "i1", ... for integers.
std::vector<std::string> property_names(const StreamHeader& header) {
  std::vector<std::string> names;
  for (unsigned i = 3; i < header.vertex_floats; ++i) names.push_back(std::string("s").append(std::to_string(i - 3)));
  for (unsigned i = 0; i < header.vertex_ints; ++i) names.push_back(std::string("i").append(std::to_string(i)));
  return names;
}

class StreamMeshReader : public MeshReader {
 public:
  StreamMeshReader(std::unique_ptr<EventReader> reader, const ReadOptions& options, std::uint64_t file_bytes)
      : reader_(in_pre_order(std::move(reader))),
        batch_events_(std::max<std::size_t>(1, options.batch_events)),
        zero_(options.signed_zeros ? -0.0 : 0.0) {
    const StreamHeader& header = reader_->header();
    info_.format = header.format;
    info_.property_names = property_names(header);
    info_.vertex_count = header.vertex_count;
    info_.simplex_count = header.cell_count;
    info_.finalizes = true;
    info_.float32 = header.vertex_ints == 0;
    info_.file_bytes = file_bytes;
    for (const auto& name : options.all_properties ? info_.property_names : options.properties)
      columns_.push_back(column_of(name));
  }

  const MeshInfo& info() const override { return info_; }
  std::uint64_t bytes_read() const override { return reader_->bytes_read(); }
  std::uint64_t memory_bytes() const override { return reader_->memory_bytes(); }

  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.coordinates.resize(info_.dimension);
    batch.properties.resize(columns_.size());
    batch.first_vertex = VertexId(vertices_);
    std::size_t count = 0;
    // Finalizations do not count towards the size of a batch, unless a batch has a single event.
    while (count < batch_events_) {
      // A batch that ends here may be empty, but lets the caller look at memory_bytes().
      if (batch_events_ != 1 && !ended_ && !reader_->prepare()) return true;
      const StreamEvent* event = next();
      if (event == nullptr) break;
      append(*event, batch);
      count += batch_events_ == 1 || event->kind != EventKind::kFinalized;
    }
    return !batch.empty();
  }

  std::vector<std::string> warnings() const override {
    auto all = reader_->warnings();
    if (ended_ && finalized_ < vertices_)
      all.push_back(std::to_string(vertices_ - finalized_) + " of " + std::to_string(vertices_) +
                    " vertices were never finalized");
    return all;
  }

 private:
  // Which value of a vertex a requested property is.
  struct Column {
    bool integer;
    std::size_t index;
  };

  Column column_of(const std::string& name) const {
    const auto& names = info_.property_names;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw missing_property(name, names).at(reader_->name());
    const auto at = static_cast<std::size_t>(found - names.begin());
    const std::size_t floats = reader_->header().vertex_floats - 3;
    return at < floats ? Column{false, 3 + at} : Column{true, at - floats};
  }

  const StreamEvent* next() {
    const StreamEvent* event = ended_ ? nullptr : reader_->next();
    ended_ = event == nullptr;
    return event;
  }

  double number(float value) const { return static_cast<double>(value) + zero_; }

  void append(const StreamEvent& event, MeshBatch& batch) {
    switch (event.kind) {
      case EventKind::kVertex:
        for (std::size_t k = 0; k < 3; ++k) batch.coordinates[k].push_back(number(event.floats[k]));
        for (std::size_t k = 0; k < columns_.size(); ++k)
          batch.properties[k].push_back(columns_[k].integer ? static_cast<double>(event.ints[columns_[k].index])
                                                            : number(event.floats[columns_[k].index]));
        ++batch.vertex_count;
        ++vertices_;
        return;
      case EventKind::kTriangle:
        for (std::size_t k = 0; k < 3; ++k) batch.triangles().emplace_back(event.corners[k]);
        return;
      case EventKind::kTetrahedron:
        for (std::size_t k = 0; k < 4; ++k) batch.tetrahedra().emplace_back(event.corners[k]);
        return;
      case EventKind::kFinalized:
        batch.finalized.emplace_back(event.vertex);
        ++finalized_;
        return;
    }
  }

  std::unique_ptr<EventReader> reader_;
  std::size_t batch_events_;
  double zero_;  // is added to each number: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing
  MeshInfo info_;
  std::vector<Column> columns_;
  std::uint64_t vertices_ = 0, finalized_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<MeshReader> make_stream_mesh_reader(std::unique_ptr<EventReader> reader, const ReadOptions& options,
                                                    std::uint64_t file_bytes) {
  return std::make_unique<StreamMeshReader>(std::move(reader), options, file_bytes);
}

}  // namespace reeb::io
