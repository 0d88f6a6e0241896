#include "tools/library/run_input.h"

#include <algorithm>

#include "io/file/checksum.h"

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

std::vector<io::FunctionSpec> parse(std::span<const std::string> functions) {
  std::vector<io::FunctionSpec> specs;
  for (const std::string& function : functions)
    specs.push_back(function.empty() ? io::FunctionSpec() : io::parse_function(function));
  return specs;
}

}  // namespace

RunInput::RunInput(const std::string& path, std::span<const std::string> functions, const InputOptions& options)
    : options_(options), input_(io::mesh_input(path, options.format)) {
  std::vector<io::FunctionSpec> specs = parse(functions);
  reading_.batch_events = options.batch_events;
  reading_.properties = io::needed_properties(specs);
  reading_.temp_folder = options.temp_dir;
  reading_.value_of_image = functions[0].empty();

  mesh_.path = path;
  mesh_.check_unchanged = [this] { input_.check_unchanged(); };
  auto content = input_.open();
  // What zstd holds with the window of its usual level, 2 MiB, is part of what any run takes.
  constexpr std::uint64_t kUsualWindow = std::uint64_t{3} << 20;
  mesh_.reader_bytes = content->memory_bytes() - std::min(content->memory_bytes(), kUsualWindow);
  mesh_.reader = io::open_mesh(input_, std::move(content), reading_, options.image, options.format);
  info_ = mesh_.reader->info();
  for (std::size_t f = 0; f < specs.size(); ++f)
    if (functions[f].empty()) specs[f] = io::default_function(info_);
  if (reading_.properties.empty()) reading_.properties = io::needed_properties(specs);
  mesh_.reading = reading_digest(info_, options.image);
  mesh_.dimension = info_.dimension;

  io::OpenMesh open_again;
  if (can_read_again()) open_again = [this] { return read_again({}); };
  fields_ = io::read_fields(specs, open_again, path, options.temp_dir, options.memory_bytes);
  for (std::size_t i = 0; i < specs.size(); ++i) {
    sources_.push_back(std::make_unique<io::FunctionSource>(specs[i], info_, reading_.properties, path, &fields_[i]));
    functions_.push_back(sources_.back().get());
  }
}

ooc::MeshInput RunInput::take_mesh() {
  mesh_.indexed = mesh_.reader->indexed();
  if (mesh_.path != "-") mesh_.read_again = [this] { return read_again(reading_); };
  if (mesh_.indexed) mesh_.reader.reset();
  return std::move(mesh_);
}

}  // namespace reeb
