#include "io/file/atomic_output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_name_is_taken(const std::string& path) {
  throw Error(ErrorKind::kBadInput, "the output exists already",
              "choose another name, or allow replacing it with --force")
      .at(path);
}

bool is_device(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

int open_or_throw(const std::string& file, int flags, const std::string& shown) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor < 0) throw_output_error(errno, "create", shown);
  return descriptor;
}

// The entry in the folder is durable only when the folder is.
void sync_folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void check_output_name(const std::string& path, Existing existing) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (path.empty() || fs::is_directory(status))
    throw Error(ErrorKind::kBadInput, "the output is a folder", "name a file").at(path);
  if (fs::is_regular_file(status) && existing == Existing::kRefuse) throw_name_is_taken(path);
}

AtomicOutputFile::AtomicOutputFile(const std::string& path, Existing existing) : path_(path), existing_(existing) {
  check_output_name(path, existing);
  if (is_device(path)) {
    out_.emplace(open_or_throw(path, O_WRONLY, path), path);
    return;
  }
  std::error_code no_such_file;
  const fs::path target = fs::canonical(path, no_such_file);
  if (!no_such_file) path_ = target.string();
  temporary_ = path_ + ".tmp-" + std::to_string(::getpid());
  ::unlink(temporary_.c_str());  // a leftover of a process that had this number
  out_.emplace(open_or_throw(temporary_, O_RDWR | O_CREAT | O_EXCL, path_), path_);
}

AtomicOutputFile::~AtomicOutputFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicOutputFile::commit() {
  out_->sync();
  out_.reset();
  if (temporary_.empty()) return;
  give_name();
  temporary_.clear();
  sync_folder_of(path_);
}

void AtomicOutputFile::give_name() {
  const unsigned flags = existing_ == Existing::kRefuse ? RENAME_NOREPLACE : 0u;
  if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), flags) == 0) return;
  if (errno == EEXIST) throw_name_is_taken(path_);
  // Some file systems know only the plain form.
  if (errno == EINVAL && ::rename(temporary_.c_str(), path_.c_str()) == 0) return;
  throw_output_error(errno, "name", path_);
}

}  // namespace reeb::io
