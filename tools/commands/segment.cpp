// `reeb segment`: which arc of a graph each vertex of its mesh lies on.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "io/file/atomic_file.h"
#include "io/file/file_name.h"
#include "io/file/temp_dir.h"
#include "io/formats/create_mesh.h"
#include "io/mesh/property_columns.h"
#include "io/vtk/vtk_mesh_writer.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "ooc/run/segment.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/measures/open_segmentation.h"
#include "tools/plot/chosen_level.h"
#include "tools/program/input_kind.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/whole_levels.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "labels are written as they are in memory");

struct SegmentOptions {
  std::string mesh, file, output, format, temp_folder;
  LevelChoice level;
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  unsigned threads = 0;
  io::ImageOptions image;
  bool force = false, quiet = false;
};

// The labels and values of vertices in the order of a reader, which leaves out the vertices of a grid without data.
class LabelStream {
 public:
  explicit LabelStream(ooc::Segmentation& segmentation) : segmentation_(segmentation) {}

  void read(std::vector<double>& labels, std::vector<double>& values, std::size_t count, ooc::ArcLabel dropped) {
    labels.clear();
    values.clear();
    while (labels.size() < count) {
      if (next_ == labels_.size()) fetch();
      const std::size_t i = next_++;
      if (std::isnan(values_[i])) continue;
      labels.push_back(static_cast<double>(labels_[i] == ooc::kDroppedVertex ? dropped : labels_[i]));
      values.push_back(values_[i]);
    }
  }

 private:
  void fetch() {
    constexpr std::uint64_t kAtOnce = 8192;
    labels_.resize(static_cast<std::size_t>(std::min(segmentation_.vertex_bound() - read_, kAtOnce)));
    if (labels_.empty()) throw input_changed();
    values_.resize(labels_.size());
    segmentation_.read(labels_, values_);
    read_ += labels_.size();
    next_ = 0;
  }

  ooc::Segmentation& segmentation_;
  std::vector<ooc::ArcLabel> labels_;
  std::vector<double> values_;
  std::size_t next_ = 0;
  std::uint64_t read_ = 0;
};

// The mesh with its labels: .ply with the property `arc`, .vtu and .vtp with `SegmentationId` and `Value`. Returns what
// was odd in the mesh, one line each.
std::vector<std::string> write_mesh(const RunInput& input, ooc::Segmentation& segmentation,
                                    const SegmentOptions& options) {
  const bool is_ply = io::name_suffix(options.output) == ".ply";
  constexpr std::uint64_t kMostOfPly = std::uint64_t{1} << 31;
  if (is_ply && std::max(segmentation.level().arc_count(), segmentation.level().node_count()) >= kMostOfPly)
    throw Error(ErrorKind::kBadInput, "PLY has no room for the numbers of so many arcs", "write .vtu or .i64")
        .at(options.output);
  ReadOptions reading;
  reading.all_properties = is_ply;
  reading.temp_folder = options.temp_folder;
  const auto reader = input.read_again(reading, /*renumber=*/true);
  const MeshInfo& info = reader->info();
  io::MeshWriterOptions writing;
  writing.dimension = info.dimension;
  writing.float64 = true;  // a coordinate read again is the same
  writing.existing = late_outputs(options.force);
  writing.temp_folder = options.temp_folder;
  if (is_ply) {
    writing.property_names = info.property_names;
    std::erase(writing.property_names, "arc");
    writing.property_names.push_back("arc");
    writing.integer_properties = {"arc"};
  } else {
    writing.property_names = {"Value", "SegmentationId"};
    writing.integer_properties = {"SegmentationId"};
  }
  const auto writer = is_ply ? io::create_mesh(options.output, writing) : io::create_vtk_mesh(options.output, writing);
  LabelStream stream(segmentation);
  std::vector<double> labels, values;
  MeshBatch batch;
  while (reader->read(batch)) {
    stream.read(labels, values, batch.vertex_count,
                is_ply ? std::numeric_limits<std::int32_t>::min() : ooc::kDroppedVertex);
    if (is_ply)
      io::erase_property(batch.properties, info.property_names, "arc");
    else
      batch.properties.assign(1, values);
    batch.properties.push_back(labels);
    writer->write(batch);
  }
  input.input().check_unchanged();
  writer->close();
  std::vector<std::string> notes = reader->warnings();
  if (is_ply && std::ranges::find(info.property_names, "arc") != info.property_names.end())
    notes.emplace_back("the mesh has a property \"arc\" already, which the labels replaced");
  return notes;
}

void write_labels(ooc::Segmentation& segmentation, const SegmentOptions& options) {
  constexpr std::uint64_t kAtOnce = 8192;
  io::AtomicFile file(options.output, {.existing = late_outputs(options.force)});
  std::vector<ooc::ArcLabel> labels;
  std::vector<double> values;
  for (std::uint64_t left = segmentation.vertex_bound(); left != 0; left -= labels.size()) {
    labels.resize(static_cast<std::size_t>(std::min(left, kAtOnce)));
    values.resize(labels.size());
    segmentation.read(labels, values);
    file.out().append(std::as_bytes(std::span(labels)));
  }
  file.commit();
}

void segment(SegmentOptions options) {
  const std::string suffix = io::name_suffix(options.output);
  if (suffix != ".i64" && suffix != ".ply" && suffix != ".vtu" && suffix != ".vtp")
    throw Error(ErrorKind::kUsage,
                suffix.empty() ? "the output has no suffix, so there is no format for the labels"
                               : "labels are not written as \"" + suffix + '"',
                "name an output that ends in .i64, .ply, .vtu or .vtp");
  check_threshold(options.level);
  require_mesh_file(options.mesh, "name the mesh first: reeb segment MESH FILE.reeb -o OUT");
  require_reeb_file(options.file, "segment " + options.mesh);
  if (options.temp_folder.empty()) options.temp_folder = io::TempDir::default_folder(options.output);
  const ooc::ReebFile file(options.file);
  RunFiles files;
  add_segmentation_inputs(options.mesh, options.format, options.image, file, files);
  files.add_output(options.output, "the output", existing_outputs(options.force));
  files.check();
  warn_of_damage(file);
  if (!options.quiet) note_large_threshold(file, options.level.threshold);
  const std::uint32_t version =
      read_part(file, FilePart::kLevel, [&] { return choose_level(file, options.level).version; });
  const bool writes_mesh = suffix != ".i64";

  RunInput input(options.mesh, std::span(&file.header().function, 1),
                 {.format = options.format,
                  .image = options.image,
                  .temp_dir = options.temp_folder,
                  .memory_bytes = options.memory_bytes});
  if (writes_mesh && !input.can_read_again())
    throw Error(ErrorKind::kBadInput, "the mesh must be read twice for this output, and this input can be read once",
                "name an output that ends in .i64, or write the mesh to a file first")
        .at(options.mesh);
  ProgressBar bar(options.quiet);
  ooc::ComputeOptions run = segmentation_run(options.threads, options.temp_folder);
  run.memory_bytes = options.memory_bytes;
  run.replace = options.force;
  run.progress = [&](const ooc::ComputeProgress& at) {
    bar.update({"following vertices"}, at.done, at.total, at.triangles);
  };
  const std::uint64_t bound = vertex_bound(file, input.info());
  const auto segmentation = read_part(file, FilePart::kLevel, [&] {
    return ooc::segment_mesh(
        input.take_mesh(), *input.functions().front(),
        {.file = file, .version = version, .vertex_bound = bound, .output = options.output, .options = std::move(run)});
  });
  bar.clear();
  std::vector<std::string> notes;
  if (writes_mesh)
    notes = write_mesh(input, *segmentation, options);
  else
    write_labels(*segmentation, options);
  if (options.quiet) return;
  for (const std::string& note : notes) print_line("note: " + printable(note));
  const ooc::SegmentCounts& counts = segmentation->counts();
  print_line(fmt::format("wrote {}: {} on {}, {} at nodes", printable(options.output),
                         count_of(counts.on_arcs, "vertex"), count_of(segmentation->level().arc_count(), "arc"),
                         with_commas(counts.nodes)) +
             (counts.dropped != 0 ? ", " + with_commas(counts.dropped) + " dropped" : ""));
}

}  // namespace

void add_segment(Program& program) {
  auto options = std::make_shared<SegmentOptions>();
  Command command = program.add_command("segment", "Write the arc on which each vertex of a mesh lies");
  command.add_option("MESH", options->mesh, "The mesh that the file was computed from; - reads standard input")
      .required()
      .type_name("");
  command.add_option("FILE", options->file, "The .reeb file").required().type_name("");
  command
      .add_option("-o,--output", options->output,
                  "File to write: .i64 (for each vertex a little-endian int64: the position of its arc among the arcs "
                  "of `reeb extract`, or -1 - the position of its node), .ply, .vtu or .vtp (the mesh with these "
                  "numbers)")
      .required()
      .type_name("FILE");
  add_level_options(command, options->level);
  add_format(command, options->format);
  add_image_options(command, options->image);
  add_memory(command, options->memory_bytes);
  add_threads(command, options->threads);
  add_temp_dir(command, options->temp_folder);
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb segment scan.ply scan.reeb --threshold 1% -o scan.i64");
  command.callback([options] { segment(*options); });
}

}  // namespace reeb::tools
