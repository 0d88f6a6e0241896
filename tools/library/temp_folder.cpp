#include "tools/library/temp_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"

namespace reeb {
namespace {

constexpr std::string_view kPrefix = "reeb-again-", kPattern = "XXXXXX";
// A file in the folder: other folders with such a name belong to the user. It is there once the folder is locked.
constexpr const char* kMark = "/.reeb-temporary";

// As far as that is possible: a later run removes the rest.
void remove_folder(const std::string& path) noexcept {
  try {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  } catch (const std::exception&) {  // no memory for the names in it
  }
}

// A descriptor of this user's folder with a lock on it; -1 if that fails.
int lock_folder(const std::string& path, int how) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return -1;
  struct stat status {};
  if (::fstat(folder, &status) == 0 && status.st_uid == ::geteuid() && ::flock(folder, how) == 0) return folder;
  ::close(folder);
  return -1;
}

void remove_abandoned_folders(const std::string& parent) {
  io::for_each_name(parent, [&](std::string_view name) {
    if (!name.starts_with(kPrefix) || name.size() != kPrefix.size() + kPattern.size()) return;
    const std::string path = parent + "/" + std::string(name);
    if (::access((path + kMark).c_str(), F_OK) != 0) return;
    const int folder = lock_folder(path, LOCK_EX | LOCK_NB);
    if (folder < 0) return;
    remove_folder(path);
    ::close(folder);
  });
}

}  // namespace

TempFolder::TempFolder(const std::string& parent) {
  const std::string place = parent.empty() ? io::TempDir::default_folder("") : parent;
  remove_abandoned_folders(place);
  path_ = place + "/" + std::string(kPrefix) + std::string(kPattern);
  if (::mkdtemp(path_.data()) == nullptr)
    throw Error(ErrorKind::kResource, std::string("cannot be created: ") + std::strerror(errno),
                "choose a folder that exists and is writable with --temp-dir DIR")
        .at(path_);
  lock_ = lock_folder(path_, LOCK_EX);
  if (lock_ < 0 && (errno == EMFILE || errno == ENFILE)) {
    const int error = errno;
    ::rmdir(path_.c_str());  // without a mark, no later run would remove it
    throw Error(ErrorKind::kResource, std::string("cannot be opened: ") + std::strerror(error), io::hint_for(error, ""))
        .at(path_);
  }
  if (lock_ < 0) return;  // where there are no locks, nobody removes it
  if (const int mark = ::open((path_ + kMark).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600); mark >= 0) ::close(mark);
}

TempFolder::~TempFolder() {
  remove_folder(path_);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace reeb
