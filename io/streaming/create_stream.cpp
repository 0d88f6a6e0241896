#include "io/streaming/create_stream.h"

#include <cmath>
#include <utility>

#include "io/events/event_text.h"
#include "io/file/atomic_file.h"
#include "io/file/file_name.h"
#include "io/file/file_ostream.h"
#include "io/mesh/written_records.h"
#include "io/text/output_buffer.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMaxStreamVertices = (std::uint64_t{1} << 31) - 1;

class EventListWriter : public StreamWriter {
 public:
  EventListWriter(std::ostream& out, StreamHeader header) : out_(out), header_(std::move(header)) {}

  void write(const StreamEvent& event) override {
    append_event(out_.text(), event, header_);
    out_.flush_if_full();
  }
  void close() override { out_.flush(); }

 private:
  OutputBuffer out_;
  StreamHeader header_;
};

std::unique_ptr<StreamWriter> make_writer(StreamFormat format, std::ostream& out, const StreamHeader& header) {
  switch (format) {
    case StreamFormat::kText:
      return make_text_writer(out, header);
    case StreamFormat::kBlocks:
      return make_block_writer(out, header);
    case StreamFormat::kCompressed:
      return make_smc_writer(out, header);
    case StreamFormat::kEvents:
    case StreamFormat::kNone:
      break;
  }
  return std::make_unique<EventListWriter>(out, header);
}

// The events of batches.
class EventListMeshWriter : public MeshWriter {
 public:
  EventListMeshWriter(const std::string& path, const MeshWriterOptions& options)
      : file_(path, {.existing = options.existing}),
        stream_(file_.out()),
        out_(stream_),
        properties_(options.property_names.size()),
        float64_(options.float64) {}

  void write(const MeshBatch& batch) override { write_events(out_, batch, properties_, float64_); }
  void close() override {
    out_.flush();
    file_.commit();
  }

 private:
  AtomicFile file_;
  FileOstream stream_;
  OutputBuffer out_;
  std::size_t properties_;
  bool float64_;
};

// A stream writer that owns its file.
class StreamFile : public StreamWriter {
 public:
  StreamFile(const std::string& path, const StreamHeader& header, Existing existing)
      : path_(path),
        file_(path, {.existing = existing, .overwrites = stream_format(path) == StreamFormat::kBlocks}),
        out_(file_.out()) {
    naming_file([&] { writer_ = make_writer(stream_format(path_), out_, header); });
  }

  void write(const StreamEvent& event) override {
    naming_file([&] { writer_->write(event); });
  }
  void close() override {
    naming_file([this] { writer_->close(); });
    file_.commit();
  }
  std::vector<std::string> warnings() const override { return writer_->warnings(); }

 private:
  // What a format cannot hold is an error of its writer, which does not know the file.
  template <class Work>
  void naming_file(const Work& work) const {
    try {
      work();
    } catch (Error& error) {
      error.at(path_);
      throw;
    }
  }

  std::string path_;
  AtomicFile file_;
  FileOstream out_;
  std::unique_ptr<StreamWriter> writer_;
};

class StreamMeshWriter : public MeshWriter {
 public:
  StreamMeshWriter(const std::string& path, const MeshWriterOptions& options)
      : path_(path),
        header_(header_of(path, options)),
        most_corners_(header_.volume ? 4 : 3),
        writer_(create_stream(path, header_, options.existing)) {}

  void write(const MeshBatch& batch) override {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) write_vertex(batch, i);
    for_each_face(batch, most_corners_, [this](std::span<const VertexId> corners) {
      if (corners.size() == 4)
        write_cell(EventKind::kTetrahedron, corners);
      else
        write_cell(EventKind::kTriangle, as_triangle(corners));
    });
    event_.kind = EventKind::kFinalized;
    for (const VertexId v : batch.finalized) {
      event_.vertex = static_cast<std::uint32_t>(v.value());
      writer_->write(event_);
    }
  }
  void close() override { writer_->close(); }

  std::vector<std::string> warnings() const override {
    auto all = writer_->warnings();
    if (rounded_ != 0)
      all.push_back("rounded to float32, which is what streaming meshes hold: " + count_of(rounded_, "vertex"));
    return all;
  }

 private:
  static StreamHeader header_of(const std::string& path, const MeshWriterOptions& options) {
    if (options.dimension > 3)
      throw Error(ErrorKind::kBadInput, "streaming meshes have three coordinates, this mesh has more",
                  "write PLY, OBJ or OFF instead")
          .at(path);
    StreamHeader header;
    header.volume = is_volume_name(path);
    if (options.vertex_count && *options.vertex_count <= kMaxStreamVertices)
      header.vertex_count = static_cast<std::uint32_t>(*options.vertex_count);
    if (options.simplex_count && *options.simplex_count <= kMaxStreamVertices)
      header.cell_count = static_cast<std::uint32_t>(*options.simplex_count);
    if (header.volume) header.vertex_floats = 3 + static_cast<unsigned>(options.property_names.size());
    if (header.vertex_floats > kMaxFloats)
      throw Error(ErrorKind::kBadInput, "streaming meshes hold at most 5 values per vertex besides its position",
                  "write PLY instead")
          .at(path);
    return header;
  }

  void write_vertex(const MeshBatch& batch, std::size_t i) {
    event_.kind = EventKind::kVertex;
    const std::uint64_t index = batch.first_vertex.value() + i;
    if (index >= kMaxStreamVertices) fail("streaming meshes hold at most 2147483647 vertices");
    event_.vertex = static_cast<std::uint32_t>(index);
    bool exact = true;
    for (std::size_t k = 0; k < header_.vertex_floats; ++k) {
      const double value = value_of(batch, i, k);
      event_.floats[k] = static_cast<float>(value);
      exact &= static_cast<double>(event_.floats[k]) == value;
      if (!std::isfinite(event_.floats[k]))
        fail("a value of vertex " + std::to_string(index) +
             (std::isfinite(value) ? " is beyond float32" : " is not finite"));
    }
    rounded_ += exact ? 0 : 1;
    writer_->write(event_);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, "write PLY or OBJ").at(path_);
  }

  static double value_of(const MeshBatch& batch, std::size_t i, std::size_t k) {
    if (k >= 3) return batch.properties[k - 3][i];
    return k < batch.coordinates.size() ? batch.coordinates[k][i] : 0.0;
  }

  void write_cell(EventKind kind, std::span<const VertexId> corners) {
    event_.kind = kind;
    for (std::size_t k = 0; k < corners.size(); ++k) event_.corners[k] = static_cast<std::uint32_t>(corners[k].value());
    writer_->write(event_);
  }

  std::string path_;
  StreamHeader header_;
  std::size_t most_corners_;  // of a cell that is written whole
  std::unique_ptr<StreamWriter> writer_;
  StreamEvent event_{};
  std::uint64_t rounded_ = 0;
};

}  // namespace

StreamFormat stream_format(const std::string& path) {
  if (path.ends_with(".events.txt")) return StreamFormat::kEvents;
  const std::string suffix = name_suffix(path);
  if (suffix == ".sma" || suffix == ".sva") return StreamFormat::kText;
  if (suffix == ".smb" || suffix == ".svb") return StreamFormat::kBlocks;
  return suffix == ".smc" ? StreamFormat::kCompressed : StreamFormat::kNone;
}

bool is_volume_name(const std::string& path) {
  const std::string suffix = name_suffix(path);
  return suffix == ".sva" || suffix == ".svb";
}

std::unique_ptr<StreamWriter> create_stream(const std::string& path, const StreamHeader& header, Existing existing) {
  return std::make_unique<StreamFile>(path, header, existing);
}

std::unique_ptr<MeshWriter> create_stream_mesh(const std::string& path, const MeshWriterOptions& options) {
  if (stream_format(path) == StreamFormat::kEvents) return std::make_unique<EventListMeshWriter>(path, options);
  return std::make_unique<StreamMeshWriter>(path, options);
}

}  // namespace reeb::io
