#include "ooc/run/partial_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

#include "io/file/file.h"
#include "io/file/system.h"
#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

// The mark: a file in every folder that a run has created.
constexpr const char* kMark = "reeb-partial";

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// Whether runs give their files such a name: checkpoint, checkpoint.partial-PID-N, function-N.nodes, function-N.arcs.
bool is_name_of_a_run(std::string_view name) {
  const auto take = [&name](std::string_view start) {
    if (!name.starts_with(start)) return false;
    name.remove_prefix(start.size());
    return true;
  };
  if (take("checkpoint")) {
    if (name.empty()) return true;
    if (!take(".partial-")) return false;
    const auto dash = name.find('-');
    return dash != std::string_view::npos && is_number(name.substr(0, dash)) && is_number(name.substr(dash + 1));
  }
  if (!take("function-")) return false;
  const auto dot = name.find('.');
  if (dot == std::string_view::npos || !is_number(name.substr(0, dot))) return false;
  return name.substr(dot) == ".nodes" || name.substr(dot) == ".arcs";
}

bool exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

// Whether the path still names the file that is open as `descriptor`.
bool is_named(int descriptor, const std::string& path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

PartialFolder::PartialFolder(const std::string& output) : path_(path_for(output)) {
  // Try again if the run that owned the folder removed it just before it was locked.
  do {
    if (folder_ >= 0) ::close(folder_);
    open();
  } while (!is_named(folder_, path_));
  try {
    claim();
  } catch (...) {
    ::close(folder_);
    throw;
  }
}

void PartialFolder::open() {
  const auto fail = [this](const char* what, const char* hint) {
    throw Error(ErrorKind::kResource, std::string(what) + ": " + std::strerror(errno), hint).at(path_);
  };
  const char* elsewhere = "write the output to a folder that exists and is writable";
  if (::mkdir(path_.c_str(), 0700) != 0 && errno != EEXIST) fail("cannot be created", elsewhere);
  if (fs::is_symlink(path_)) refuse("is a symbolic link, not a folder that a run has made");
  folder_ = io::system::open(path_, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
  if (folder_ < 0) fail("cannot be opened", elsewhere);
  if (::access(path_.c_str(), W_OK | X_OK) != 0) fail("cannot be written", elsewhere);
  // A file system without locks must not prevent a run.
  if (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(folder_);
    throw Error(ErrorKind::kResource, "another run is writing this output",
                "wait until it has ended, or choose another output with -o")
        .at(path_);
  }
}

// The folder is ours if it has the mark. An empty folder gets the mark: the run that created it could have ended before
// it set the mark.
void PartialFolder::claim() {
  struct stat folder {
  }, mark{};
  if (::fstat(folder_, &folder) != 0 || folder.st_uid != ::geteuid()) refuse("belongs to another user");
  if (::fstatat(folder_, kMark, &mark, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(mark.st_mode)) return;
  if (!entries().empty()) refuse("has files in it and was not made by a run");
  const int made = io::system::open(file(kMark), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (made < 0) io::throw_output_error(errno, path_);
  ::close(made);
}

void PartialFolder::refuse(const char* why) const {
  throw Error(ErrorKind::kResource, std::string(why) + ", so it is left alone",
              "move it away, or choose another output with -o")
      .at(path_);
}

PartialFolder::~PartialFolder() {
  if (!has_checkpoint()) {
    clear();
    if (has_only_the_mark()) {
      ::unlinkat(folder_, kMark, 0);
      ::rmdir(path_.c_str());
    }
  }
  ::close(folder_);
}

// If not, files of another origin keep the folder, with its mark for the next run.
bool PartialFolder::has_only_the_mark() const noexcept try {
  const auto left = entries();
  return left.size() == 1 && left[0] == kMark;
} catch (const std::bad_alloc&) {
  return false;
}

bool PartialFolder::has_checkpoint(const std::string& output) { return exists(path_for(output) + "/checkpoint"); }

bool PartialFolder::has_checkpoint() const { return exists(checkpoint()); }

void PartialFolder::sync_name() {
  if (!name_is_synced_) io::sync_folder(io::folder_of(path_));
  name_is_synced_ = true;
}

void PartialFolder::clear() noexcept try {
  if (::unlinkat(folder_, "checkpoint", 0) == 0) io::system::sync(folder_);
  for (const std::string& name : entries())
    if (is_name_of_a_run(name)) ::unlinkat(folder_, name.c_str(), 0);
} catch (const std::bad_alloc&) {  // the next run removes the rest
}

std::vector<std::string> PartialFolder::entries() const {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
    names.push_back(entry->path().filename().string());
  return names;
}

}  // namespace reeb::ooc
