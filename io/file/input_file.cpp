#include "io/file/input_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "io/file/file_name.h"
#include "libreeb/base/error.h"

namespace reeb::io {

void check_input_file(const std::string& path) {
  if (path.empty())
    throw Error(ErrorKind::kBadInput, "the name of an input is empty", "name a file; perhaps a variable is not set")
        .because(ErrorCause::kMissing);
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(ErrorKind::kBadInput, "there is no such file", "check the path").at(path).because(ErrorCause::kMissing);
  if (failure == std::errc::too_many_symbolic_link_levels)
    throw Error(ErrorKind::kBadInput, "this is a symbolic link that leads to itself", "name a file").at(path);
  if (std::filesystem::is_directory(status))
    throw Error(ErrorKind::kBadInput, "this is a folder, not a file", "name a file in it").at(path);
  if (::access(path.c_str(), R_OK) != 0)
    throw Error(ErrorKind::kBadInput, std::string("cannot be read: ") + std::strerror(errno),
                "check the permissions of the file")
        .at(path);
}

namespace {

std::int64_t nanoseconds(const timespec& time) { return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec; }

FileState to_state(const struct stat& status) {
  return {.bytes = static_cast<std::uint64_t>(status.st_size),
          .modified_ns = nanoseconds(status.st_mtim),
          .changed_ns = nanoseconds(status.st_ctim),
          .device = status.st_dev,
          .inode = status.st_ino,
          .names = status.st_nlink};
}

}  // namespace

FileState state_of(const File& file) {
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0) file.fail("ask the size of", errno, 0, 0);
  return to_state(status);
}

InputFile::InputFile(const std::string& path, Empty empty) : empty_(empty) {
  check_input_file(path);
  if (!is_regular_file(path))
    throw Error(ErrorKind::kBadInput, "is not a regular file", "copy it to a regular file first").at(path);
  file_ = File::open_for_reading(path);
  state_ = state_of(file_);
  const bool is_packed = content_name(path) != path;
  if (size() == 0 && (empty == Empty::kRefused || is_packed)) throw_empty(path);
}

InputFile::InputFile(File file) : file_(std::move(file)), state_(state_of(file_)) {}

void InputFile::check_unchanged(const char* content) const {
  if (state_.names == 0) return;  // no other program can open a file that never had a name
  const FileState now = state_of(file_);
  // A program can set the time of modification back, but not that of the change. Names come and go without one.
  const bool written = now.bytes != state_.bytes || now.modified_ns != state_.modified_ns ||
                       (now.changed_ns != state_.changed_ns && now.names == state_.names);
  struct stat status {};
  const bool replaced =
      ::stat(path().c_str(), &status) == 0 && (status.st_dev != state_.device || status.st_ino != state_.inode);
  if (written || replaced) throw input_changed(std::string(content) + " changed while it was read").at(path());
}

std::shared_ptr<const InputFile> open_if_regular(const std::string& path, Empty empty) {
  if (path == "-") return nullptr;
  check_input_file(path);
  return is_regular_file(path) ? std::make_shared<const InputFile>(path, empty) : nullptr;
}

void throw_empty(const std::string& path) {
  const std::string fault = is_streaming_name(path) ? "TRUNCATED: " : "";
  throw Error(ErrorKind::kBadInput, fault + "the file is empty", "check how the file was written").at(path, "0");
}

}  // namespace reeb::io
