#include "tools/program/convert_mesh.h"

#include <iterator>
#include <utility>

#include "io/events/event_text.h"
#include "io/events/pre_order.h"
#include "io/file/content_source.h"
#include "io/file/file_name.h"
#include "io/file/file_ostream.h"
#include "io/formats/create_mesh.h"
#include "io/formats/format_detection.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "io/streaming/create_stream.h"
#include "io/streaming/event_input.h"
#include "io/streaming/stream_mesh_reader.h"
#include "libreeb/base/error.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/whole_mesh/compact_stream.h"
#include "ooc/whole_mesh/triangle_order.h"

namespace reeb::tools {
namespace {

using Lines = std::vector<std::string>;

void append(Lines& all, Lines more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

class Conversion {
 public:
  explicit Conversion(const ConvertOptions& options)
      : options_(options),
        format_(io::stream_format(options.output)),
        sorts_(options.finalize || options.order.kind != TriangleOrder::Kind::kKeep) {}

  Lines run() {
    auto source = io::open_content(options_.input);
    if (io::detect_format(*source, options_.input) == io::MeshFormat::kStreaming) {
      const std::uint64_t bytes = source->file_bytes();
      auto events = io::open_events(std::move(source), options_.input);
      if (can_copy_events(events->header())) return copy_events(std::move(events));
      const ReadOptions& options = read_options(io::stream_property_names(events->header()));
      reader_ = io::make_stream_mesh_reader(std::move(events), options, bytes);
    } else {
      reader_ = io::open_mesh(std::move(source), options_.input, read_options(properties_of_input()));
    }
    // Without finalization all vertices of the mesh would stay active in the writer.
    sorts_ |= format_ == io::StreamFormat::kCompressed && !reader_->info().finalizes;
    if (sorts_) return write_sorted();
    return format_ == io::StreamFormat::kEvents ? list_events() : copy_batches();
  }

 private:
  bool can_copy_events(const io::StreamHeader& header) const {
    if (sorts_ || format_ == io::StreamFormat::kNone) return false;
    return format_ == io::StreamFormat::kEvents || header.volume == io::is_volume_name(options_.output);
  }

  Lines copy_events(std::unique_ptr<io::EventReader> events) const {
    if (format_ == io::StreamFormat::kCompressed) events = io::in_pre_order(std::move(events));
    const auto writer = io::create_stream(options_.output, events->header(), options_.existing);
    while (const io::StreamEvent* event = events->next()) writer->write(*event);
    writer->close();
    Lines notes = events->warnings();
    append(notes, writer->warnings());
    return notes;
  }

  // Other values of vertices are kept if the output can hold them.
  bool holds_properties() const {
    return io::name_suffix(options_.output) == ".ply" || io::is_volume_name(options_.output);
  }

  // The options for reading a mesh that has these properties.
  const ReadOptions& read_options(Lines known_properties) {
    if (holds_properties())
      read_options_.properties = std::move(known_properties);
    else if (options_.order.function)
      read_options_.properties = io::needed_properties({&*options_.order.function, 1});
    // With batches of one event, finalizations stay directly after the triangles that they follow.
    if (!sorts_ && format_ != io::StreamFormat::kNone) read_options_.batch_events = 1;
    return read_options_;
  }

  // The properties of a pipe cannot be read in advance.
  Lines properties_of_input() const {
    if (!holds_properties() || options_.input == "-") return {};
    return io::open_mesh(options_.input)->info().property_names;
  }

  std::unique_ptr<MeshWriter> create_writer(std::optional<std::uint64_t> vertex_count) const {
    const MeshInfo& info = reader_->info();
    io::MeshWriterOptions options;
    options.dimension = info.dimension;
    options.float64 = !info.float32;
    options.existing = options_.existing;
    options.temp_folder = options_.temp_folder;
    if (holds_properties()) options.property_names = read_options_.properties;
    // SMC leaves out vertices that no triangle names.
    if (format_ != io::StreamFormat::kCompressed) options.vertex_count = vertex_count;
    return io::create_mesh(options_.output, options);
  }

  Lines list_events() {
    io::AtomicFile file(options_.output, {.existing = options_.existing});
    io::FileOstream out(file.out());
    io::write_events(*reader_, out);
    file.commit();
    return reader_->warnings();
  }

  Lines copy_batches() {
    const MeshInfo& info = reader_->info();
    // The counts that a stream's header announces can be wrong.
    const auto writer = create_writer(info.finalizes ? std::nullopt : info.vertex_count);
    copy_mesh(*reader_, *writer);
    Lines notes = reader_->warnings();
    append(notes, writer->warnings());
    return notes;
  }

  Lines write_sorted();
  std::unique_ptr<IndexedMesh> index(ooc::Workspace& space, Lines& notes);
  std::unique_ptr<IndexedMesh> sorted(std::unique_ptr<IndexedMesh> mesh, ooc::Workspace& space) const;

  const ConvertOptions& options_;
  io::StreamFormat format_;
  bool sorts_;
  std::unique_ptr<MeshReader> reader_;
  ReadOptions read_options_;
};

Lines Conversion::write_sorted() {
  if (io::is_volume_name(options_.output))
    throw Error(ErrorKind::kUsage, "volume meshes are converted in their own order only",
                "leave --finalize and --order out, or write a triangle mesh");
  ooc::Workspace space(options_.temp_folder, options_.memory_bytes);
  Lines notes;
  auto mesh = sorted(index(space, notes), space);
  const bool exact = format_ != io::StreamFormat::kNone;
  const auto writer = create_writer(mesh->vertex_count());
  ooc::write_compact(*mesh, reader_->info().dimension, exact, *writer, space);
  writer->close();
  append(notes, writer->warnings());
  return notes;
}

std::unique_ptr<IndexedMesh> Conversion::index(ooc::Workspace& space, Lines& notes) {
  if (auto mesh = reader_->indexed()) return mesh;
  ooc::SpoolOptions options;
  options.allowance_bytes = 2 * space.share();
  auto mesh = ooc::spool(*reader_, space.temp, space.budget, options);
  append(notes, reader_->warnings());
  return mesh;
}

std::unique_ptr<IndexedMesh> Conversion::sorted(std::unique_ptr<IndexedMesh> mesh, ooc::Workspace& space) const {
  const unsigned dimension = reader_->info().dimension;
  switch (options_.order.kind) {
    case TriangleOrder::Kind::kKeep:
      return mesh;
    case TriangleOrder::Kind::kHilbert:
      return ooc::sorted_along_hilbert(std::move(mesh), dimension, space);
    case TriangleOrder::Kind::kSpectral:
      return ooc::sorted_by_spectrum(std::move(mesh), dimension, space);
    case TriangleOrder::Kind::kSweep:
      break;
  }
  io::FunctionSource function(*options_.order.function, reader_->info(), read_options_.properties, options_.input);
  return ooc::sorted_by_function(std::move(mesh), function, space);
}

}  // namespace

TriangleOrder parse_order(const std::string& text) {
  using Kind = TriangleOrder::Kind;
  if (text == "keep") return {};
  if (text == "hilbert") return {Kind::kHilbert, {}};
  if (text == "spectral") return {Kind::kSpectral, {}};
  if (text.starts_with("sweep:")) return {Kind::kSweep, io::parse_function(text.substr(6))};
  throw Error(ErrorKind::kUsage, "'" + text + "' is not an order of triangles",
              "use keep, hilbert, spectral or sweep:FUNC");
}

Lines convert_mesh(const ConvertOptions& options) { return Conversion(options).run(); }

}  // namespace reeb::tools
