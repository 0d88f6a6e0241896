#include "tools/library/run_input.h"

#include <algorithm>

#include "io/file/checksum.h"
#include "io/file/file_name.h"
#include "io/file/temp_dir.h"
#include "io/formats/format_detection.h"
#include "io/formats/open_grid.h"
#include "io/formats/open_input.h"
#include "libreeb/base/error.h"
#include "tools/library/held_mesh.h"

namespace reeb {
namespace {

// What a run on an image depends on and its file does not say.
std::uint64_t reading_digest(const MeshInfo& info, const io::ImageOptions& image) {
  if (!info.grid) return 0;
  std::uint64_t digest = image.skip_nodata ? 1 : 0;
  const auto add = [&](const auto& numbers) { digest = io::checksum(std::as_bytes(std::span(numbers)), digest); };
  add(info.grid->size);
  add(info.grid->origin);
  add(std::span(info.format));
  for (const auto& step : info.grid->step) add(step);
  return digest;
}

}  // namespace

ooc::MeshSize size_of(const MeshInfo& info) {
  constexpr std::uint64_t kTiny = 10'000, kSmall = 100'000, kTrianglesOfVoxel = 12, kBytesOfTriangle = 40;
  std::uint64_t triangles = 0;  // about
  if (info.grid)
    triangles = info.grid->vertex_count() * kTrianglesOfVoxel;
  else if (info.simplex_count)
    triangles = *info.simplex_count;
  else if (info.file_bytes != 0)
    triangles = info.file_bytes / kBytesOfTriangle;
  else
    return ooc::MeshSize::kAny;  // a pipe
  if (triangles > kSmall) return ooc::MeshSize::kAny;
  return triangles > kTiny ? ooc::MeshSize::kSmall : ooc::MeshSize::kTiny;
}

InputOptions input_options(const ComputeOptions& options, const std::string& output) {
  return {.format = options.format,
          .image = options.image,
          .temp_dir = options.temp_dir.empty() ? io::TempDir::default_folder(output) : options.temp_dir,
          .memory_bytes = options.memory_bytes};
}

std::vector<io::FunctionSpec> parse_functions(std::span<const std::string> functions) {
  std::vector<io::FunctionSpec> specs;
  for (const std::string& function : functions)
    specs.push_back(function.empty() ? io::FunctionSpec() : io::parse_function(function));
  return specs;
}

void refuse_value_of_mesh(const io::Input& input, std::span<const io::FunctionSpec> specs, const std::string& format,
                          const io::ImageOptions& image) {
  const auto value = std::ranges::find(specs, io::FunctionSpec::Kind::kValue, &io::FunctionSpec::kind);
  const bool may_be_raw = image.is_raw() || io::content_suffix(input.path()) == ".raw";
  if (value == specs.end() || may_be_raw || !format.empty() || !input.can_reopen()) return;
  if (io::detect_image(*input.open(), input.path())) return;
  if (io::detect_format(*input.open(), input.path()) == io::MeshFormat::kUnknown) return;
  throw Error(ErrorKind::kBadInput, "the mesh is not an image, so it has no " + value->text,
              value->text + " is the function of an image; " + input.path() +
                  " is a mesh: choose a coordinate, property:NAME or file:PATH")
      .at(input.path());
}

RunInput::RunInput(const std::string& path, std::span<const std::string> functions, const InputOptions& options)
    : options_(options), file_(io::mesh_input(path, options.format)) {
  mesh_.path = path;
  mesh_.check_unchanged = [this] { file_->check_unchanged(); };
  auto content = file_->open();
  // What zstd holds with the window of its usual level, 2 MiB, is part of what any run takes.
  constexpr std::uint64_t kUsualWindow = std::uint64_t{3} << 20;
  mesh_.reader_bytes = content->memory_bytes() - std::min(content->memory_bytes(), kUsualWindow);
  open(functions, std::move(content));
}

RunInput::RunInput(MeshOpener open_held, std::span<const std::string> functions, const InputOptions& options)
    : options_(options), held_(std::move(open_held)) {
  mesh_.path = std::string(1, '-');
  mesh_.may_resume = false;
  open(functions, nullptr);
}

void RunInput::open(std::span<const std::string> functions, std::unique_ptr<io::ContentSource> content) {
  std::vector<io::FunctionSpec> specs = parse_functions(functions);
  if (!held_) refuse_value_of_mesh(*file_, specs, options_.format, options_.image);
  reading_.batch_events = options_.batch_events;
  reading_.properties = io::needed_properties(specs);
  reading_.temp_folder = options_.temp_dir;
  reading_.value_of_image = functions[0].empty();
  mesh_.reader = held_ ? open_held(held_, reading_)
                       : io::open_mesh(*file_, std::move(content), reading_, options_.image, options_.format);
  info_ = mesh_.reader->info();
  for (std::size_t f = 0; f < specs.size(); ++f)
    if (functions[f].empty()) specs[f] = io::default_function(info_);
  if (reading_.properties.empty()) reading_.properties = io::needed_properties(specs);
  mesh_.reading = reading_digest(info_, options_.image);
  mesh_.dimension = info_.dimension;
  mesh_.size = size_of(info_);

  io::OpenMesh open_again;
  if (can_read_again()) open_again = [this] { return read_again({}); };
  const std::string name = held_ ? std::string() : mesh_.path;
  fields_ = io::read_fields(specs, open_again, name, options_.temp_dir, options_.memory_bytes);
  for (std::size_t i = 0; i < specs.size(); ++i) {
    sources_.push_back(std::make_unique<io::FunctionSource>(specs[i], info_, reading_.properties, name, &fields_[i]));
    functions_.push_back(sources_.back().get());
    // Of an image, the place of a vertex is read at once. A run would need all of it as a mesh to look it up.
    if (info_.grid && open_again && sources_.back()->needs_lookup()) sources_.back()->look_up(*open_again());
  }
}

std::unique_ptr<MeshReader> RunInput::read_again(const ReadOptions& options, bool renumber) const {
  if (held_) return open_held(held_, options);
  io::ImageOptions image = options_.image;
  image.renumber = renumber;
  return io::open_mesh(*file_, file_->open(), options, image, options_.format);
}

ooc::MeshInput RunInput::take_mesh() {
  mesh_.indexed = mesh_.reader->indexed();
  if (held_ || mesh_.path != "-") mesh_.read_again = [this] { return read_again(reading_); };
  if (mesh_.indexed) mesh_.reader.reset();
  return std::move(mesh_);
}

}  // namespace reeb
