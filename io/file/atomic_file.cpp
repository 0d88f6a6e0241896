#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/file/system.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;

// PATH.partial-PID-N
constexpr std::string_view kSuffix = ".partial-";

[[noreturn]] void throw_name_is_taken(const std::string& path) {
  throw Error(ErrorKind::kBadInput, "the output exists already",
              "choose another name, or allow replacing it with --force")
      .at(path)
      .because(ErrorCause::kExists);
}

// 0666 minus the umask. umask() returns the mask only by setting it, which other threads could notice, so /proc is read
// first.
mode_t usual_mode() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("Umask:")) return 0666 & ~static_cast<mode_t>(std::strtoul(line.c_str() + 6, nullptr, 8));
  const mode_t mask = ::umask(077);
  ::umask(mask);
  return 0666 & ~mask;
}

bool has_name(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

std::string follow_links(const std::string& path) {
  constexpr int kMaxLinks = 40;  // the limit of the system
  fs::path place = path;
  std::error_code ignored;
  for (int i = 0; i < kMaxLinks; ++i) {
    if (!fs::is_symlink(fs::symlink_status(place, ignored))) return place.string();
    const fs::path target = fs::read_symlink(place, ignored);
    place = target.is_absolute() ? target : place.parent_path() / target;
  }
  throw Error(ErrorKind::kBadInput, "this is a symbolic link that leads to itself", "name a file").at(path);
}

void check_output_name(const std::string& path, Existing existing) {
  if (is_device(path)) return;
  std::error_code ignored;
  const fs::file_status status = fs::status(path.empty() ? path : follow_links(path), ignored);
  // A folder exists, and no permission makes it an output.
  if (path.empty() || fs::is_directory(status))
    throw Error(existing == Existing::kReplace ? ErrorKind::kResource : ErrorKind::kBadInput, "the output is a folder",
                "name a file")
        .at(path)
        .because(path.empty() ? ErrorCause::kNone : ErrorCause::kExists);
  if (fs::is_regular_file(status) && existing == Existing::kRefuse) throw_name_is_taken(path);
}

void require_output_folder(const std::string& path, const char* how) {
  if (is_device(path)) {
    if (path != kStandardOutput && ::access(path.c_str(), W_OK) != 0) throw_output_error(errno, path);
    return;
  }
  const std::string target = follow_links(path), folder = folder_of(target);
  // The temporary file has a longer name.
  constexpr std::size_t kMaxName = 255, kSuffixBytes = sizeof(".partial-4194304-9") - 1;
  if (fs::path(target).filename().string().size() + kSuffixBytes > kMaxName)
    throw Error(ErrorKind::kResource,
                "the name of the output is too long: until it is whole, it has a suffix of " +
                    std::to_string(kSuffixBytes) + " bytes",
                "choose a name of at most " + std::to_string(kMaxName - kSuffixBytes) + " bytes")
        .at(path);
  const int probe = system::open_unnamed(folder);
  if (probe < 0)
    throw Error(ErrorKind::kResource,
                std::string("the output cannot be written to this folder: ") + std::strerror(errno),
                hint_for(errno, std::string("choose a folder that exists and is writable ") + how))
        .at(folder);
  ::close(probe);
}

bool is_partial_name(std::string_view name, std::string_view of) {
  for (const std::string_view start : {of, kSuffix}) {
    if (!name.starts_with(start)) return false;
    name.remove_prefix(start.size());
  }
  const auto is_number = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  const auto dash = name.find('-');
  return dash != std::string_view::npos && is_number(name.substr(0, dash)) && is_number(name.substr(dash + 1));
}

void remove_abandoned(const std::string& path) {
  if (is_device(path)) return;
  const std::string target = follow_links(path), folder = folder_of(target);
  const std::string own = fs::path(target).filename().string();
  for_each_name(folder, [&](std::string_view name) {
    if (!is_partial_name(name, own)) return;
    const std::string place = folder + "/" + std::string(name);
    const int file = system::open(place, O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) return;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(place.c_str());
    ::close(file);
  });
}

AtomicFile::AtomicFile(const std::string& path, const AtomicOptions& options) : path_(path), options_(options) {
  check_output_name(path_, options_.existing);
  if (is_device(path_)) {
    open_device();
    return;
  }
  target_ = follow_links(path_);
  remove_abandoned(target_);
  open_temporary();
}

void AtomicFile::open_temporary() {
  File file;
  for (unsigned attempt = 0; !file.is_open(); ++attempt) {
    std::string name = target_ + std::string(kSuffix) + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    const int descriptor = system::open(name, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) throw_output_error(errno, path_);
    temporary_ = TemporaryName(std::move(name));
    file = File(descriptor, path_, File::Use::kOutput);
    // The lock is for remove_abandoned(). If that ran between the two calls, it has removed the file, and another is
    // created.
    ::flock(descriptor, LOCK_EX);
    if (!has_name(descriptor)) file = {};
  }
  out_.emplace(std::move(file), options_.buffer_bytes);
}

void AtomicFile::open_device() {
  const bool standard = path_ == kStandardOutput;
  const int descriptor = standard ? system::duplicate(STDOUT_FILENO) : system::open(path_, O_WRONLY);
  const std::string name = standard ? kStandardOutputShown : path_;
  if (descriptor < 0) throw_output_error(errno, name);
  File device(descriptor, name, File::Use::kOutput);
  if (options_.overwrites) {
    collected_ = std::move(device);
    device = TempDir(options_.temp_folder.empty() ? TempDir::default_folder(path_) : options_.temp_folder)
                 .create_unnamed("output");
  }
  out_.emplace(std::move(device), options_.buffer_bytes);
}

void AtomicFile::commit() {
  if (collected_) return copy_to_device();
  out_->sync();
  if (!temporary_.empty()) give_name();
  out_.reset();  // releases the lock, as the last step
}

void AtomicFile::copy_to_device() {
  out_->flush();
  BufferedWriter device(std::move(*collected_));
  device.append_file(*out_);
  device.sync();
  out_.reset();
}

void AtomicFile::give_name() {
  struct stat old {};
  const bool replaces = ::stat(target_.c_str(), &old) == 0;
  // Only a file system without modes refuses this.
  (void)!::fchmod(out_->file().descriptor(), replaces ? old.st_mode & 0777 : usual_mode());
  const bool may_replace = options_.existing == Existing::kReplace;
  const int error =
      may_replace ? system::rename(temporary_.path(), target_) : system::rename_to_new(temporary_.path(), target_);
  if (error == EEXIST && !may_replace) give_other_name();
  if (error != 0) throw_output_error(error, path_);
  temporary_.release();
  name_ = target_;
  if (const int failed = system::sync_folder(folder_of(target_)); failed != 0) throw_output_error(failed, path_);
}

// The work was done, so its result is kept.
void AtomicFile::give_other_name() {
  constexpr int kMost = 1000;
  for (int number = 2; number < kMost; ++number) {
    const std::string ending = std::string(".").append(std::to_string(number));
    std::string name = target_ + ending;
    const int error = system::rename_to_new(temporary_.path(), name);
    if (error == EEXIST) continue;
    if (error != 0) throw_output_error(error, path_);
    temporary_.release();
    name_ = std::move(name);
    throw Error(ErrorKind::kBadInput,
                "another program made this file in the meantime, so the output is " + path_ + ending,
                "rename one of the two, or allow replacing with --force")
        .at(path_);
  }
  throw_name_is_taken(path_);
}

}  // namespace reeb::io
