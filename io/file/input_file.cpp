#include "io/file/input_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "io/file/file_name.h"
#include "libreeb/base/error.h"

namespace reeb::io {

void check_input_file(const std::string& path) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (status.type() == std::filesystem::file_type::not_found)
    throw Error(ErrorKind::kBadInput, "there is no such file", "check the path").at(path);
  if (std::filesystem::is_directory(status))
    throw Error(ErrorKind::kBadInput, "is a directory, not a file", "name a file in it").at(path);
  if (::access(path.c_str(), R_OK) != 0)
    throw Error(ErrorKind::kBadInput, std::string("cannot be read: ") + std::strerror(errno),
                "check the permissions of the file")
        .at(path);
}

MappableFile::MappableFile(const std::string& path) {
  check_input_file(path);
  if (!is_regular_file(path))
    throw Error(ErrorKind::kBadInput, "is not a regular file, so it cannot be mapped",
                "copy it to a regular file first")
        .at(path);
  file_ = File::open_for_reading(path);
  size_ = file_.size();
  if (size_ == 0) throw_empty(path);
}

void throw_empty(const std::string& path) {
  const std::string fault = is_streaming_name(path) ? "TRUNCATED: " : "";
  throw Error(ErrorKind::kBadInput, fault + "is empty", "check how the file was written").at(path, "0");
}

}  // namespace reeb::io
