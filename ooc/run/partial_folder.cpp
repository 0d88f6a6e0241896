#include "ooc/run/partial_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "io/file/atomic_file.h"
#include "io/file/file.h"
#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

bool is_ours(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.starts_with("checkpoint") || name.ends_with(".nodes") || name.ends_with(".arcs");
}

bool exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

// Whether `descriptor` is what has the name now.
bool is_named(int descriptor, const std::string& path) {
  struct stat opened {
  }, named{};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

}  // namespace

PartialFolder::PartialFolder(const std::string& output) : path_(path_for(output)) {
  // Again if the run that had the folder removed it just before it was locked.
  do {
    if (folder_ >= 0) ::close(folder_);
    open();
  } while (!is_named(folder_, path_));
}

void PartialFolder::open() {
  const auto fail = [this](const char* what, const char* hint) {
    throw Error(ErrorKind::kResource, std::string(what) + ": " + std::strerror(errno), hint).at(path_);
  };
  const char* elsewhere = "write the output to a folder that exists and that you may write to";
  if (::mkdir(path_.c_str(), 0777) != 0 && errno != EEXIST) fail("cannot be made", elsewhere);
  folder_ = ::open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0) fail("cannot be opened", elsewhere);
  if (::access(path_.c_str(), W_OK | X_OK) != 0) fail("cannot be written", elsewhere);
  // A file system without locks is no reason not to work on it.
  if (::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(folder_);
    throw Error(ErrorKind::kResource, "another run is writing this output",
                "wait until it has ended, or choose another output with -o")
        .at(path_);
  }
}

PartialFolder::~PartialFolder() {
  if (!has_checkpoint()) {
    clear();
    ::rmdir(path_.c_str());  // if nothing else is in it
  }
  ::close(folder_);
}

bool PartialFolder::has_checkpoint(const std::string& output) { return exists(path_for(output) + "/checkpoint"); }

bool PartialFolder::has_checkpoint() const { return exists(checkpoint()); }

void PartialFolder::sync_name() {
  if (!name_is_synced_) io::sync_folder(io::folder_of(path_));
  name_is_synced_ = true;
}

void PartialFolder::clear() noexcept {
  if (::unlink(checkpoint().c_str()) == 0) ::fsync(folder_);
  std::error_code error;
  for (fs::directory_iterator entry(path_, error), end; !error && entry != end; entry.increment(error))
    if (is_ours(entry->path())) ::unlink(entry->path().c_str());
}

}  // namespace reeb::ooc
