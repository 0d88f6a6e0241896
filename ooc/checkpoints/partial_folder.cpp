#include "ooc/checkpoints/partial_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>

#include "io/file/atomic_file.h"
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
  constexpr std::string_view kCheckpoint = "checkpoint", kFunction = "function-";
  if (name == kCheckpoint || io::is_partial_name(name, kCheckpoint)) return true;
  if (!name.starts_with(kFunction)) return false;
  name.remove_prefix(kFunction.size());
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

// A file system without modes shows every folder as open to all, and nothing can change that.
bool others_may_write(int folder, mode_t mode) {
  constexpr mode_t kOthers = S_IWGRP | S_IWOTH, kAll = 07777;
  if ((mode & kOthers) == 0 || ::fchmod(folder, mode & kAll & ~kOthers) != 0) return false;
  struct stat changed {};
  const bool has_modes = ::fstat(folder, &changed) == 0 && (changed.st_mode & kOthers) == 0;
  if (has_modes) (void)!::fchmod(folder, mode & kAll);
  return has_modes;
}

}  // namespace

PartialFolder::PartialFolder(const std::string& output) : path_(path_for(output)) {
  try {
    // Try again if the run that owned the folder removed it just before it was locked.
    do {
      if (folder_ >= 0) ::close(std::exchange(folder_, -1));
      open();
    } while (!is_named(folder_, path_));
    claim();
  } catch (...) {
    if (is_new_) ::rmdir(path_.c_str());
    if (folder_ >= 0) ::close(folder_);
    throw;
  }
}

void PartialFolder::open() {
  const auto fail = [this](const char* what, const char* hint) {
    throw Error(ErrorKind::kResource, std::string(what) + ": " + std::strerror(errno), io::hint_for(errno, hint))
        .at(path_);
  };
  const char* elsewhere = "write the output to a folder that exists and is writable";
  is_new_ = ::mkdir(path_.c_str(), 0700) == 0;
  if (!is_new_ && errno != EEXIST) fail("cannot be created", elsewhere);
  std::error_code unknown;  // then it cannot be opened
  if (fs::is_symlink(path_, unknown)) refuse("is a symbolic link, not a folder that a run has made");
  folder_ = io::system::open(path_, O_RDONLY | O_DIRECTORY | O_NOFOLLOW);
  if (folder_ < 0) fail("cannot be opened", elsewhere);
  if (::access(path_.c_str(), W_OK | X_OK) != 0) fail("cannot be written", elsewhere);
  // A file system without locks must not prevent a run.
  if (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw Error(ErrorKind::kResource, "another run is writing this output",
                "wait until it has ended, or choose another output with -o")
        .at(path_);
}

// The folder is ours if it has the mark. An empty folder gets the mark: the run that created it could have ended before
// it set the mark.
void PartialFolder::claim() {
  struct stat folder {
  }, mark{};
  if (::fstat(folder_, &folder) != 0 || folder.st_uid != ::geteuid()) refuse("belongs to another user");
  // In such a folder, the name of a file can become a link to another file at any moment.
  if (others_may_write(folder_, folder.st_mode)) refuse("can be written by other users");
  if (::fstatat(folder_, kMark, &mark, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(mark.st_mode)) return;
  if (has_other_than("")) refuse("has files in it and no mark that a run has made it");
  const int made = io::system::open(file(kMark), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0600);
  if (made < 0) io::throw_output_error(errno, path_);
  ::close(made);
}

void PartialFolder::refuse(const char* why) const {
  throw Error(ErrorKind::kResource, std::string(why) + ", so it is left alone",
              "move it away, or remove it if an older reeb left it; or choose another output with -o")
      .at(path_);
}

PartialFolder::~PartialFolder() {
  if (!has_checkpoint()) {
    clear();
    if (!has_other_than(kMark)) {  // files of another origin keep the folder, with its mark for the next run
      ::unlinkat(folder_, kMark, 0);
      ::rmdir(path_.c_str());
    }
  }
  ::close(folder_);
}

bool PartialFolder::has_checkpoint(const std::string& output) { return exists(path_for(output) + "/checkpoint"); }

bool PartialFolder::has_checkpoint() const noexcept { return ::faccessat(folder_, "checkpoint", F_OK, 0) == 0; }

void PartialFolder::sync_name() {
  if (!name_is_synced_) io::sync_folder(io::folder_of(path_));
  name_is_synced_ = true;
}

void PartialFolder::clear() noexcept {
  if (::unlinkat(folder_, "checkpoint", 0) == 0) io::system::sync(folder_);
  io::for_each_name(path_, [this](const char* name) {
    if (is_name_of_a_run(name)) ::unlinkat(folder_, name, 0);
  });
}

bool PartialFolder::has_other_than(std::string_view known) const noexcept {
  bool has = false;
  io::for_each_name(path_, [&](std::string_view name) { has = has || name != known; });
  return has;
}

}  // namespace reeb::ooc
