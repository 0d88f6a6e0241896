#include "io/file/input_file.h"

#include <unistd.h>

#include <boost/interprocess/exceptions.hpp>
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

MappableFile::MappableFile(const std::string& path) : path_(path) {
  check_input_file(path);
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure))
    throw Error(ErrorKind::kBadInput, "is not a regular file, so it cannot be mapped",
                "copy it to a regular file first")
        .at(path);
  size_ = std::filesystem::file_size(path, failure);
  if (failure) throw Error(ErrorKind::kBadInput, "cannot be read: " + failure.message(), "check the file").at(path);
  if (size_ == 0) throw_empty(path);
  try {
    mapping_ = boost::interprocess::file_mapping(path.c_str(), boost::interprocess::read_only);
  } catch (const boost::interprocess::interprocess_exception& problem) {
    throw Error(ErrorKind::kBadInput, std::string("cannot be opened: ") + problem.what(), "check the file").at(path);
  }
}

void throw_empty(const std::string& path) {
  const std::string fault = is_streaming_name(path) ? "TRUNCATED: " : "";
  throw Error(ErrorKind::kBadInput, fault + "is empty", "check how the file was written").at(path, "0");
}

}  // namespace reeb::io
