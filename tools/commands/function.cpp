// `reeb function MESH -f FUNC -o OUT`: the values of a function at the vertices of a mesh.
#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/file/content_source.h"
#include "io/file/file_name.h"
#include "io/file/file_ostream.h"
#include "io/file/temp_dir.h"
#include "io/formats/create_mesh.h"
#include "io/formats/open_input.h"
#include "io/functions/function_source.h"
#include "io/functions/mesh_field.h"
#include "io/images/numpy.h"
#include "io/mesh/property_columns.h"
#include "io/text/output_buffer.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/base/printable.h"
#include "libreeb/port/vertex_numbering.h"
#include "ooc/chunks/reader_memory.h"
#include "tools/arguments/image_options.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/program/output.h"
#include "tools/program/progress.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are in memory");

struct FunctionOptions {
  std::string mesh, format, function, output, temp_folder;
  std::vector<std::string> functions;  // as they were given
  std::uint64_t memory_bytes = MemoryBudget::kUnlimited;
  io::ImageOptions image;
  bool force = false, quiet = false;
};

// "" is the default, which depends on the mesh.
io::FunctionSpec parse(const std::string& function) {
  return function.empty() ? io::FunctionSpec() : io::parse_function(function);
}

// The mesh with its function, batch by batch.
class Values {
 public:
  explicit Values(const FunctionOptions& options)
      : options_(options),
        spec_(parse(options.function)),
        input_(io::mesh_input(options.mesh, options.format)),
        bar_(options.quiet),
        budget_(options.memory_bytes),
        reader_memory_(budget_) {}

  void write() {
    input_.read([this] {
      open();
      if (io::name_suffix(options_.output) == ".ply")
        write_mesh();
      else
        write_values(io::name_suffix(options_.output));
    });
    bar_.clear();
    if (options_.quiet) return;
    for (const std::string& line : reader_->warnings()) print_line("note: " + printable(line));
    for (const std::string& line : field_.notes) print_line("note: " + printable(line));
    print_line(fmt::format("wrote {}: {} for {}", printable(options_.output), printable(spec_.text),
                           count_of(numbers_.count(), "vertex")));
  }

 private:
  void open() {
    refuse_value_of_mesh(input_, std::span(&spec_, 1), options_.format, options_.image);
    ReadOptions read_options;
    read_options.all_properties = io::name_suffix(options_.output) == ".ply";
    read_options.properties = io::needed_properties(std::span(&spec_, 1));
    read_options.value_of_image = options_.function.empty();
    reader_ = io::open_mesh(input_, input_.open(), read_options, options_.image, options_.format);
    if (options_.function.empty()) spec_ = io::default_function(reader_->info());
    io::OpenMesh open_again;
    if (input_.can_reopen())
      open_again = [this] { return io::open_mesh(input_, input_.open(), {}, options_.image, options_.format); };
    field_ = std::move(
        io::read_fields(std::span(&spec_, 1), open_again, options_.mesh, options_.temp_folder, options_.memory_bytes)
            .front());
    if (options_.function.empty()) read_options.properties = io::needed_properties(std::span(&spec_, 1));
    const auto& properties = read_options.all_properties ? reader_->info().property_names : read_options.properties;
    source_ = std::make_unique<io::FunctionSource>(spec_, reader_->info(), properties, options_.mesh, &field_);
    if (!source_->needs_lookup()) return;
    if (!open_again)
      throw Error(ErrorKind::kBadInput, spec_.text + " needs a vertex first, and this input can be read only once",
                  "write the mesh to a file first, or name a point: distance:X,Y,Z")
          .at(options_.mesh == "-" ? io::kStandardInputShown : options_.mesh);
    source_->look_up(*open_again());
  }

  // Reads the next batch and its values. False at the end.
  bool read() {
    if (!reader_->read(batch_)) {
      source_->check_count(numbers_.count());
      source_->check_unchanged();
      return false;
    }
    reader_memory_.update(*reader_);
    values_.resize(batch_.vertex_count);
    source_->evaluate(batch_, values_);
    numbers_.append(batch_.first_vertex.value(), batch_.vertex_count);
    bar_.update({"writing"}, reader_->bytes_read(), reader_->info().file_bytes);
    return true;
  }

  void write_mesh() {
    const MeshInfo& info = reader_->info();
    io::MeshWriterOptions writing;
    writing.dimension = info.dimension;
    writing.property_names = info.property_names;
    std::erase(writing.property_names, spec_.text);
    // x, y, z and coordinates after them are in the file under these names already.
    const bool adds_property =
        spec_.kind != io::FunctionSpec::Kind::kCoordinate || (spec_.number < 3 && spec_.text.size() > 1);
    if (adds_property) writing.property_names.push_back(spec_.text);
    writing.float64 = true;  // a value read again is the same
    writing.existing = late_outputs(options_.force);
    writing.temp_folder = options_.temp_folder;
    const auto writer = io::create_mesh(options_.output, writing);
    while (read()) {
      renumber();
      io::erase_property(batch_.properties, info.property_names, spec_.text);
      if (adds_property) batch_.properties.push_back(values_);
      writer->write(batch_);
    }
    input_.check_unchanged();
    writer->close();
  }

  // Files of meshes have no vertices that are left out.
  void renumber() {
    if (!numbers_.has_gaps()) return;
    const auto to_index = [this](VertexId& id) { id = VertexId(numbers_.index_of(id.value()).value()); };
    batch_.first_vertex = VertexId(numbers_.count() - batch_.vertex_count);
    for (auto& corners : batch_.simplices) std::ranges::for_each(corners, to_index);
    std::ranges::for_each(batch_.finalized, to_index);
  }

  // A value for each number; NaN for a vertex that is left out.
  void write_values(const std::string& suffix) {
    const bool numpy = suffix == ".npy";
    io::AtomicOptions writing;
    writing.existing = late_outputs(options_.force);
    writing.overwrites = numpy;
    writing.temp_folder = options_.temp_folder;
    io::AtomicFile file(options_.output, writing);
    if (numpy) file.out().append(io::numpy_header(0));
    if (numpy || suffix == ".f64") {
      const auto count = put_values([&](std::span<const double> values) { file.out().append(std::as_bytes(values)); });
      if (numpy) file.out().overwrite(0, io::numpy_header(count));
    } else {
      io::FileOstream stream(file.out());
      io::OutputBuffer out(stream);
      put_values([&](std::span<const double> values) {
        for (const double value : values) out << io::Shortest{value} << '\n';
      });
      out.flush();
    }
    input_.check_unchanged();
    file.commit();
  }

  // Returns how many.
  template <class Put>
  std::uint64_t put_values(const Put& put) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t written = 0;
    const auto fill_to = [&](std::uint64_t number) {
      for (; written < number; ++written) put(std::span(&none, 1));
    };
    while (read()) {
      if (values_.empty()) continue;
      fill_to(batch_.first_vertex.value());
      put(values_);
      written += values_.size();
    }
    fill_to(reader_->info().number_count.value_or(written));
    return written;
  }

  const FunctionOptions& options_;
  io::FunctionSpec spec_;
  io::Input input_;
  ProgressBar bar_;
  MemoryBudget budget_;
  ooc::ReaderMemory reader_memory_;
  std::unique_ptr<MeshReader> reader_;
  io::MeshField field_;
  std::unique_ptr<io::FunctionSource> source_;
  MeshBatch batch_;
  std::vector<double> values_;
  VertexNumbering numbers_;
};

void run_function(FunctionOptions options) {
  const std::string suffix = io::name_suffix(options.output);
  if (suffix != ".f64" && suffix != ".npy" && suffix != ".txt" && suffix != ".ply")
    throw Error(ErrorKind::kUsage,
                suffix.empty() ? "the output has no suffix, so there is no format for the values"
                               : "values are not written as \"" + suffix + '"',
                "name an output that ends in .f64, .npy, .txt or .ply");
  if (options.functions.size() > 1)
    throw Error(ErrorKind::kUsage,
                fmt::format("reeb function takes one function; -f was given {}",
                            options.functions.size() == 2 ? "twice" : "several times"),
                "run it once for each function");
  if (!options.functions.empty()) options.function = options.functions.front();
  const io::FunctionSpec spec = parse(options.function);
  if (options.temp_folder.empty()) options.temp_folder = io::TempDir::default_folder(options.output);
  RunFiles files;
  files.add_mesh(options.mesh, options.format, options.image);
  files.add_values_of(spec);
  files.add_output(options.output, "the output", existing_outputs(options.force));
  files.check();
  Values(options).write();
}

}  // namespace

void add_function(Program& program) {
  auto options = std::make_shared<FunctionOptions>();
  Command command = program.add_command("function", "Write the values of a function on a mesh");
  command.add_option("MESH", options->mesh, "Mesh of any format, also as .gz and .zst; - reads standard input")
      .required()
      .type_name("");
  command.add_option("-f,--function", options->functions, "The function, as for `reeb compute`")
      .one_value_each_time()
      .option_text("FUNC");
  command
      .add_option("-o,--output", options->output,
                  "File to write: .f64 (raw float64, little endian), .npy (a NumPy array), .txt (one number per line), "
                  "or .ply (the mesh, with the function as a property of this name)")
      .required()
      .type_name("FILE");
  add_format(command, options->format);
  add_image_options(command, options->image);
  add_memory(command, options->memory_bytes);
  add_temp_dir(command, options->temp_folder);
  add_force(command, options->force);
  add_quiet(command, options->quiet);
  command.footer("Example:\n  reeb function scan.ply -f geodesic:0 -o scan-distance.ply");
  command.callback([options] { run_function(*options); });
}

}  // namespace reeb::tools
