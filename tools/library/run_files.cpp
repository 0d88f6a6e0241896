#include "tools/library/run_files.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "io/file/file.h"
#include "io/formats/open_input.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"
#include "ooc/checkpoints/partial_folder.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLeastDigits = 6;  // of the number of a snapshot

// What a name leads to.
struct Place {
  std::optional<std::pair<dev_t, ino_t>> file, folder;
  std::string name;  // in the folder
  bool is_character_device = false;
};

std::optional<std::pair<dev_t, ino_t>> identity(const struct stat& status) {
  return std::pair(status.st_dev, status.st_ino);
}

Place place_of(const std::string& path, bool is_output) {
  Place place;
  struct stat status {};
  if (path == io::kStandardOutput) {
    // Two sockets or terminals in one are usual; a file is not.
    if (::fstat(is_output ? STDOUT_FILENO : STDIN_FILENO, &status) == 0 && S_ISREG(status.st_mode))
      place.file = identity(status);
    return place;
  }
  if (::stat(path.c_str(), &status) == 0) {
    place.file = identity(status);
    place.is_character_device = S_ISCHR(status.st_mode);
    return place;
  }
  const std::string target = io::follow_links(path);
  if (::stat(io::folder_of(target).c_str(), &status) != 0) return place;
  place.folder = identity(status);
  place.name = fs::path(target).filename().string();
  return place;
}

// Nothing is lost in a character device.
bool is_same(const Place& a, const Place& b) {
  if (a.file || b.file) return a.file == b.file && !a.is_character_device;
  return a.folder && a.folder == b.folder && a.name == b.name;
}

// The number in the name of a snapshot with this stem, both without folder.
std::optional<std::uint64_t> snapshot_number(std::string_view name, std::string_view stem) {
  constexpr std::string_view kSuffix = ".reeb";
  if (!name.starts_with(stem) || !name.ends_with(kSuffix) || name.size() <= stem.size() + kSuffix.size()) return {};
  const std::string_view digits = name.substr(stem.size() + 1, name.size() - stem.size() - 1 - kSuffix.size());
  if (name[stem.size()] != '-' || digits.size() < kLeastDigits) return {};
  if (digits.size() > kLeastDigits && digits[0] == '0') return {};
  return io::whole_number<std::uint64_t>(digits);
}

}  // namespace

void RunFiles::add_input(std::string path, std::string what) { inputs_.push_back({std::move(path), std::move(what)}); }

void RunFiles::add_mesh(const std::string& path, const std::string& format, const io::ImageOptions& image) {
  add_input(path, "the mesh");
  for (std::string& other : io::files_beside(path, format, image)) add_input(std::move(other), "a file of the mesh");
}

void RunFiles::add_values_of(const io::FunctionSpec& function) {
  if (function.kind == io::FunctionSpec::Kind::kFile) add_input(function.argument, "the file of values");
}

void RunFiles::add_output(std::string path, std::string what, io::Existing existing, const char* how) {
  outputs_.push_back({std::move(path), std::move(what), existing, how});
}

void RunFiles::add_standard_output(std::string what) {
  add_output(io::kStandardOutput, std::move(what), io::Existing::kReplace);
}

void RunFiles::add_snapshots(const std::string& stem, io::Existing existing) {
  const auto is_snapshot = [name = fs::path(stem).filename().string()](std::string_view found) {
    return snapshot_number(found, name).has_value();
  };
  add_series({io::folder_of(stem), "a snapshot", is_snapshot, existing});
  first_snapshots_.push_back(snapshot_name(stem, 1));
}

void RunFiles::add_series(Series series) { series_.push_back(std::move(series)); }

// With the files of series that exist.
std::vector<RunFiles::File> RunFiles::outputs() const {
  std::vector<File> all = outputs_;
  for (const Series& series : series_) {
    std::vector<std::string> names;
    io::for_each_name(series.folder, [&](const char* name) {
      if (series.has_name(name)) names.emplace_back(name);
    });
    std::ranges::sort(names);
    for (const std::string& name : names)
      all.push_back(
          {series.folder == "." ? name : series.folder + "/" + name, series.what, series.existing, "with -o FILE"});
  }
  return all;
}

void RunFiles::check() const {
  const std::vector<File> all = outputs();
  std::vector<Place> places;
  for (const File& output : all) {
    places.push_back(place_of(output.path, true));
    const Place& place = places.back();
    for (const File& input : inputs_)
      if (is_same(place, place_of(input.path, false)))
        throw Error(
            ErrorKind::kBadInput, output.what + " is " + input.what + " itself",
            output.path == io::kStandardOutput ? "lead standard output to another file" : "choose another name for it")
            .at(output.path);
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      if (is_same(place, places[i]) || (output.path == io::kStandardOutput && all[i].path == output.path))
        throw Error(ErrorKind::kBadInput, output.what + " and " + all[i].what + " are the same file",
                    "choose different names")
            .at(output.path);
  }
  check_names_of_series();
  try {
    for (const File& output : all) io::check_output_name(output.path, output.existing);
  } catch (const Error& error) {
    if (error.cause() != ErrorCause::kExists || why_existing_.empty()) throw;
    throw error.with_hint(why_existing_ + "; " + error.hint());
  }
  for (const File& output : all) io::require_output_folder(output.path, output.how);
  for (const std::string& name : first_snapshots_) io::require_output_folder(name);
}

// Files of series that do not exist yet.
void RunFiles::check_names_of_series() const {
  for (const Series& series : series_) {
    struct stat status {};
    if (::stat(series.folder.c_str(), &status) != 0) continue;
    for (const std::vector<File>* files : {&inputs_, &outputs_})
      for (const File& file : *files) {
        const std::string target = io::follow_links(file.path);
        struct stat other {};
        if (!series.has_name(fs::path(target).filename().string())) continue;
        if (::stat(io::folder_of(target).c_str(), &other) != 0 || identity(other) != identity(status)) continue;
        throw Error(ErrorKind::kBadInput, file.what + " has the name of " + series.what, "choose another name for it")
            .at(file.path);
      }
  }
}

void require_an_output_each(std::span<const std::string> functions, std::span<const std::string> outputs) {
  if (functions.empty() || functions.size() != outputs.size())
    throw Error(ErrorKind::kUsage,
                "there are " + std::to_string(functions.size()) + " functions and " + std::to_string(outputs.size()) +
                    " outputs",
                "name one output for each function, and at least one function");
}

RunFiles files_of_run(const std::string& mesh, std::span<const io::FunctionSpec> functions,
                      std::span<const std::string> outputs, const ComputeOptions& options) {
  // Said first: the default output of a .reeb file is the file itself.
  if (mesh != "-" && ooc::is_reeb_file(mesh))
    throw Error(ErrorKind::kBadInput, "this is a Reeb graph already, not a mesh",
                "look at it with `reeb info " + mesh + "`, or write a level of it with `reeb extract " + mesh + "`")
        .at(mesh);
  // A run that is resumed may have written some of its outputs before.
  const bool continues = options.resume && ooc::PartialFolder::has_checkpoint(outputs[0]);
  const bool replace = options.replace || continues;
  const io::Existing existing = replace ? io::Existing::kReplace : io::Existing::kRefuse;
  RunFiles files;
  if (options.resume && !continues) files.explain_existing("there is nothing to resume");
  files.add_mesh(mesh, options.format, options.image);
  for (const io::FunctionSpec& function : functions) files.add_values_of(function);
  if (!io::is_device(outputs[0])) files.add_input(ooc::PartialFolder::path_for(outputs[0]), "the folder of the run");
  for (std::size_t i = 0; i < outputs.size(); ++i)
    files.add_output(outputs[i], outputs.size() == 1 ? "the output" : "the output of " + functions[i].text, existing);
  if (options.snapshot_every != 0)
    for (const std::string& output : outputs) {
      require_room_for_several(output);
      files.add_snapshots(snapshot_stem(output), existing);
    }
  if (mesh != "-") {
    const std::string sidecar = mesh + ".final";
    const bool is_sidecar = ooc::is_sidecar(sidecar);
    // One that is there and fits is read, and replaced if it does not fit.
    if (options.keep_sidecar)
      files.add_output(sidecar, "the sidecar", is_sidecar ? io::Existing::kReplace : existing,
                       "for the mesh, or leave out --sidecar");
    else if (is_sidecar)
      files.add_input(sidecar, "the sidecar of the mesh");
  }
  return files;
}

void require_room_for_several(const std::string& output) {
  if (!io::is_device(output)) return;
  const std::string device = output == io::kStandardOutput ? "standard output" : output + ", which is not a file";
  throw Error(ErrorKind::kUsage, "several outputs cannot go to " + device, "name a file with -o");
}

std::string snapshot_stem(const std::string& output) {
  fs::path stem = output;
  if (stem.extension() == ".reeb") stem.replace_extension();
  return stem.string();
}

std::string snapshot_name(const std::string& stem, std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < kLeastDigits) digits.insert(0, kLeastDigits - digits.size(), '0');
  return stem + "-" + digits + ".reeb";
}

std::vector<std::uint64_t> existing_snapshots(const std::string& stem) {
  const std::string name = fs::path(stem).filename().string();
  std::vector<std::uint64_t> numbers;
  io::for_each_name(io::folder_of(stem), [&](const char* found) {
    if (const auto number = snapshot_number(found, name)) numbers.push_back(*number);
  });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace reeb
