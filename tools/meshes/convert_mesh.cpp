#include "tools/meshes/convert_mesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

#include "io/events/pre_order.h"
#include "io/file/content_source.h"
#include "io/file/file_name.h"
#include "io/formats/create_mesh.h"
#include "io/formats/format_detection.h"
#include "io/formats/format_names.h"
#include "io/formats/open_input.h"
#include "io/functions/function_source.h"
#include "io/functions/mesh_field.h"
#include "io/images/image_format.h"
#include "io/mesh/property_columns.h"
#include "io/mesh/scalar_bytes.h"
#include "io/streaming/create_stream.h"
#include "io/streaming/open_stream.h"
#include "io/streaming/stream_mesh_reader.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/chunks/reader_memory.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/whole_mesh/compact_stream.h"
#include "ooc/whole_mesh/triangle_order.h"

namespace reeb::tools {
namespace {

using Lines = std::vector<std::string>;

void append(Lines& all, Lines more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

// Passes on what another reader delivers, and shows how far it is.
class WatchedReader : public MeshReader {
 public:
  WatchedReader(MeshReader& reader, ProgressBar::Pass pass, ProgressBar& bar)
      : reader_(reader), pass_(pass), bar_(bar) {}

  const MeshInfo& info() const override { return reader_.info(); }
  std::uint64_t bytes_read() const override { return reader_.bytes_read(); }
  std::uint64_t memory_bytes() const override { return reader_.memory_bytes(); }
  std::string memory_hint() const override { return reader_.memory_hint(); }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }
  bool read(MeshBatch& batch) override {
    const bool more = reader_.read(batch);
    simplices_ += batch.simplex_count();
    constexpr std::uint64_t kBatchesBetweenUpdates = 1024;  // of one event
    if (batch.vertex_count + batch.simplex_count() > 1 || ++batches_ % kBatchesBetweenUpdates == 0)
      bar_.update(pass_, reader_.bytes_read(), reader_.info().file_bytes, simplices_);
    return more;
  }

 private:
  MeshReader& reader_;
  const ProgressBar::Pass pass_;
  ProgressBar& bar_;
  std::uint64_t simplices_ = 0, batches_ = 0;
};

// The same for a mesh that is looked up.
class WatchedMesh : public IndexedMesh {
 public:
  WatchedMesh(IndexedMesh& mesh, ProgressBar::Pass pass, ProgressBar& bar) : mesh_(mesh), pass_(pass), bar_(bar) {}

  std::uint64_t vertex_count() const override { return mesh_.vertex_count(); }
  unsigned column_count() const override { return mesh_.column_count(); }
  void gather(std::span<const VertexId> ids, std::span<const unsigned> columns, std::span<double> values) override {
    mesh_.gather(ids, columns, values);
    if (!io::all_finite(values))
      non_finite_values_ +=
          static_cast<std::uint64_t>(std::ranges::count_if(values, [](double x) { return !std::isfinite(x); }));
  }
  // How many of these values were NaN or infinities.
  std::uint64_t non_finite_values() const { return non_finite_values_; }
  void to_original(std::span<VertexId> ids) override { mesh_.to_original(ids); }
  std::uint64_t number_count() const override { return mesh_.number_count(); }
  void from_original(std::span<VertexId> ids) const override { mesh_.from_original(ids); }
  SimplexCounts simplex_counts() const override { return mesh_.simplex_counts(); }
  void rewind() override { mesh_.rewind(); }
  bool read(std::vector<VertexId>& corners, std::size_t limit) override {
    bar_.update(pass_, mesh_.bytes_read(), mesh_.bytes_total());
    return mesh_.read(corners, limit);
  }
  std::uint64_t bytes_read() const override { return mesh_.bytes_read(); }
  std::uint64_t bytes_total() const override { return mesh_.bytes_total(); }
  std::vector<std::string> warnings() const override { return mesh_.warnings(); }

 private:
  IndexedMesh& mesh_;
  const ProgressBar::Pass pass_;
  ProgressBar& bar_;
  std::uint64_t non_finite_values_ = 0;
};

class Conversion {
 public:
  Conversion(const ConvertOptions& options, ProgressBar& bar)
      : options_(options),
        input_(io::mesh_input(options.input, options.format)),
        bar_(bar),
        format_(io::stream_format(options.output)),
        sorts_(options.finalize || options.order.kind != TriangleOrder::Kind::kKeep) {}

  Lines run() {
    return input_.read([this] { return convert(); });
  }

 private:
  io::MeshFormat kind_of(io::ContentSource& source) const {
    const std::string& format = options_.format;
    return format.empty() ? io::detect_format(source, options_.input) : io::chosen_format(format, source);
  }

  Lines convert() {
    auto source = input_.open();
    const std::string& format = options_.format;
    const bool names_image = options_.image.is_raw() || io::image_format_named(format).has_value();
    if (!names_image && kind_of(*source) == io::MeshFormat::kStreaming) {
      const std::uint64_t bytes = source->file_bytes();
      auto events = io::open_stream(std::move(source), io::name_for_streams(options_.input, format));
      if (can_copy_events(events->header())) return copy_stream(std::move(events), bytes);
      reader_ = io::make_stream_mesh_reader(std::move(events), read_options(), bytes);
    } else {
      io::ImageOptions image = options_.image;
      // In mesh formats, numbers have no gaps. What is sorted gets such numbers later, when it is spooled: until then,
      // functions need the indices of the image.
      image.renumber = !sorts_;
      reader_ = io::open_mesh(input_, std::move(source), read_options(), image, format);
    }
    // Without finalization all vertices of the mesh would stay active in the writer.
    sorts_ |= format_ == io::StreamFormat::kCompressed && !reader_->info().finalizes;
    Lines notes = sorts_ ? write_sorted() : copy_batches();
    if (has_volume_image() && (sorts_ || !io::has_tetrahedra(options_.output)))
      notes.emplace_back("all faces of the tetrahedra are written, not an isosurface");
    return notes;
  }

  bool can_copy_events(const io::StreamHeader& header) const {
    if (sorts_ || format_ == io::StreamFormat::kNone) return false;
    return format_ == io::StreamFormat::kEvents || header.volume == io::is_volume_name(options_.output);
  }

  // Counts in a head can be wrong, and a reader of a text refuses too few elements. So the stream is copied again then.
  // If it cannot be read again, such counts are left out.
  Lines copy_stream(std::unique_ptr<io::EventReader> events, std::uint64_t bytes) const {
    Lines notes;
    io::StreamHeader header = events->header();
    const bool may_have_fewer = header.format.starts_with("SMC");
    if (may_have_fewer && !input_.can_reopen()) header.vertex_count = header.cell_count = std::nullopt;
    if (header.box && !is_box(*header.box)) {
      header.box.reset();
      notes.emplace_back("left out: the bounding box of the head, whose corners are the wrong way round");
    }
    const std::optional<StreamCounts> others = copy_events(std::move(events), header, bytes, notes);
    if (!others) return notes;
    header.vertex_count = others->vertices;
    header.cell_count = others->cells;
    copy_events(io::open_stream(input_.open(), io::name_for_streams(options_.input, options_.format)), header, bytes,
                notes);
    return notes;
  }

  static bool is_box(const io::StreamBox& box) {
    return std::ranges::equal(box.min, box.max, [](float min, float max) { return min <= max; });
  }

  struct StreamCounts {
    std::uint32_t vertices = 0, cells = 0;
  };
  // Whether a file with this head would announce other counts than it has.
  bool announces_others(const io::StreamHeader& header, const StreamCounts& counts) const {
    const bool are_patched = format_ == io::StreamFormat::kBlocks, has_counts = format_ != io::StreamFormat::kEvents;
    const auto differs = [](std::optional<std::uint32_t> announced, std::uint32_t count) {
      return announced && *announced != count;
    };
    return has_counts && !are_patched && input_.can_reopen() &&
           (differs(header.vertex_count, counts.vertices) || differs(header.cell_count, counts.cells));
  }

  // Writes the file, unless it would announce wrong counts: then the right ones are returned. In SMC they may be wrong
  // by the vertices in no triangle, which it leaves out.
  std::optional<StreamCounts> copy_events(std::unique_ptr<io::EventReader> events, const io::StreamHeader& header,
                                          std::uint64_t bytes, Lines& notes) const {
    constexpr std::uint64_t kEventsBetweenUpdates = 4096;
    if (format_ == io::StreamFormat::kCompressed) events = io::in_pre_order(std::move(events));
    StreamCounts counts;
    const auto writer = io::create_stream(options_.output, header, options_.existing);
    MemoryBudget budget(options_.memory_bytes);
    Reservation reader_memory = budget.reserve("mesh reader", 0);
    for (std::uint64_t n = 0;; ++n) {
      while (!events->prepare()) reader_memory.resize(events->memory_bytes());
      const io::StreamEvent* event = events->next();
      if (event == nullptr) break;
      writer->write(*event);
      if (event->kind == io::EventKind::kVertex) ++counts.vertices;
      if (event->kind == io::EventKind::kTriangle || event->kind == io::EventKind::kTetrahedron) ++counts.cells;
      if (n % kEventsBetweenUpdates != 0) continue;
      reader_memory.resize(events->memory_bytes());
      bar_.update({"converting"}, events->bytes_read(), bytes);
    }
    input_.check_unchanged();
    if (announces_others(header, counts)) return counts;
    writer->close();
    append(notes, events->warnings());
    append(notes, writer->warnings());
    return {};
  }

  bool has_volume_image() const {
    const auto& grid = reader_->info().grid;
    return grid && std::ranges::all_of(grid->size, [](std::uint64_t size) { return size > 1; });
  }

  // Other values of vertices are kept if the output can hold them.
  bool holds_properties() const {
    return io::name_suffix(options_.output) == ".ply" || io::is_volume_name(options_.output);
  }

  ReadOptions read_options() const {
    ReadOptions options;
    options.all_properties = holds_properties();
    options.properties = requested_properties();
    // With batches of one event, finalizations stay directly after the triangles that they follow.
    if (!sorts_ && format_ != io::StreamFormat::kNone) options.batch_events = 1;
    return options;
  }

  // Those that the order needs, if not all are kept.
  Lines requested_properties() const {
    if (!options_.order.function) return {};
    return io::needed_properties({&*options_.order.function, 1});
  }

  // The columns after the coordinates.
  Lines property_columns() const {
    return holds_properties() ? reader_->info().property_names : requested_properties();
  }

  std::unique_ptr<MeshWriter> create_writer(std::optional<std::uint64_t> vertex_count) const {
    const MeshInfo& info = reader_->info();
    io::MeshWriterOptions options;
    options.dimension = info.dimension;
    options.float64 = !info.float32;
    options.existing = options_.existing;
    options.temp_folder = options_.temp_folder;
    if (holds_properties()) options.property_names = reader_->info().property_names;
    // SMC leaves out vertices that no triangle names.
    if (format_ != io::StreamFormat::kCompressed) options.vertex_count = vertex_count;
    return io::create_mesh(options_.output, options);
  }

  Lines copy_batches() {
    const MeshInfo& info = reader_->info();
    // The counts that a stream's header announces can be wrong.
    const auto writer = create_writer(info.finalizes ? std::nullopt : info.vertex_count);
    WatchedReader watched(*reader_, {"converting"}, bar_);
    MemoryBudget budget(options_.memory_bytes);
    ooc::ReaderMemory reader_memory(budget);
    for (MeshBatch batch; watched.read(batch);) {
      reader_memory.update(watched);
      writer->write(batch);
    }
    input_.check_unchanged();
    writer->close();
    Lines notes = reader_->warnings();
    append(notes, writer->warnings());
    return notes;
  }

  bool sorts_order() const { return options_.order.kind != TriangleOrder::Kind::kKeep; }
  Lines write_sorted();
  Lines notes_on_other_simplices(const SimplexCounts& counts) const;
  std::unique_ptr<IndexedMesh> spool(ooc::Workspace& space, Lines& notes);
  std::unique_ptr<IndexedMesh> sorted(std::unique_ptr<IndexedMesh> mesh, ooc::Workspace& space) const;

  const ConvertOptions& options_;
  io::Input input_;
  ProgressBar& bar_;
  io::StreamFormat format_;
  bool sorts_;
  std::unique_ptr<MeshReader> reader_;
};

Lines Conversion::write_sorted() {
  if (io::is_volume_name(options_.output))
    throw Error(ErrorKind::kUsage, "volume meshes are converted in their own order only",
                "leave --finalize and --order out, or write a triangle mesh");
  ooc::Workspace space(options_.temp_folder, options_.memory_bytes);
  Lines notes;
  // The file itself was not read from its beginning to its end, so nobody counted its values that are not finite.
  auto indexed = reader_->indexed();
  const bool in_place = indexed != nullptr;
  auto mesh = sorted(in_place ? std::move(indexed) : spool(space, notes), space);
  WatchedMesh watched(*mesh, {"writing"}, bar_);
  const bool exact = format_ != io::StreamFormat::kNone;
  const auto writer = create_writer(mesh->vertex_count());
  ooc::write_compact(watched, reader_->info().dimension, exact, *writer, space);
  input_.check_unchanged();
  writer->close();
  if (in_place && watched.non_finite_values() != 0)
    notes.push_back(io::note_on_non_finite_values(watched.non_finite_values()));
  append(notes, notes_on_other_simplices(mesh->simplex_counts()));
  append(notes, writer->warnings());
  return notes;
}

// Only triangles are put in another order. Which simplices the output could hold, but are triangles there.
Lines Conversion::notes_on_other_simplices(const SimplexCounts& counts) const {
  const std::uint64_t lower = counts[0] + counts[1],
                      higher = std::accumulate(counts.begin() + 3, counts.end(), std::uint64_t{0});
  Lines notes;
  if (lower != 0 && format_ == io::StreamFormat::kNone)
    notes.push_back("points and edges (" + with_commas(lower) + ") are written as triangles with repeated corners");
  if (higher != 0 && io::has_tetrahedra(options_.output) && !has_volume_image())
    notes.push_back("simplices of more than three corners (" + with_commas(higher) +
                    ") are written as their triangles");
  if (!notes.empty()) notes.back() += "; without --finalize and --order they stay what they are";
  return notes;
}

std::unique_ptr<IndexedMesh> Conversion::spool(ooc::Workspace& space, Lines& notes) {
  ooc::SpoolOptions options;
  options.allowance_bytes = 2 * space.share();
  options.cells = CellTriangles::kAll;
  options.progress = [&](const MeshReader& reader) {
    bar_.update({"reading", sorts_order() ? 2u : 1u}, reader.bytes_read(), reader.info().file_bytes);
  };
  auto mesh = ooc::spool(*reader_, space.temp, space.budget, options);
  append(notes, reader_->warnings());
  return mesh;
}

std::unique_ptr<IndexedMesh> Conversion::sorted(std::unique_ptr<IndexedMesh> mesh, ooc::Workspace& space) const {
  const unsigned dimension = reader_->info().dimension;
  const std::function<void(double)> progress = [&](double done) {
    constexpr std::uint64_t kSteps = 10000;
    bar_.update({"sorting on disk", 1}, static_cast<std::uint64_t>(done * kSteps), kSteps);
  };
  switch (options_.order.kind) {
    case TriangleOrder::Kind::kKeep:
      return mesh;
    case TriangleOrder::Kind::kHilbert:
      return ooc::sorted_along_hilbert(std::move(mesh), dimension, space, progress);
    case TriangleOrder::Kind::kSpectral:
      return ooc::sorted_by_spectrum(std::move(mesh), dimension, space, progress);
    case TriangleOrder::Kind::kSweep:
      break;
  }
  io::OpenMesh open_again;
  if (input_.can_reopen())
    open_again = [&] { return io::open_mesh(input_, input_.open(), {}, options_.image, options_.format); };
  const auto fields = io::read_fields({&*options_.order.function, 1}, open_again, options_.input, options_.temp_folder,
                                      options_.memory_bytes);
  io::FunctionSource function(*options_.order.function, reader_->info(), property_columns(), options_.input,
                              &fields.front());
  function.look_up(*mesh);
  auto sorted_mesh = ooc::sorted_by_function(std::move(mesh), function, space, progress);
  function.check_unchanged();
  return sorted_mesh;
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

Lines convert_mesh(const ConvertOptions& options, ProgressBar& bar) { return Conversion(options, bar).run(); }

}  // namespace reeb::tools
