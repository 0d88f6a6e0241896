#include "ooc/temp_dir.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::ooc {

namespace {

[[noreturn]] void refuse_folder(const std::string& folder, int error) {
  throw Error(ErrorKind::kResource,
              std::string("temporary files cannot be written there: ") + std::strerror(error),
              "choose a folder that can be written with --temp-dir DIR")
      .at(folder);
}

}  // namespace

TempDir::TempDir(std::string folder, WriteFault fault)
    : folder_(folder.empty() ? default_folder("") : std::move(folder)),
      fault_(fault ? std::make_shared<const WriteFault>(std::move(fault)) : nullptr) {
  struct stat status {};
  if (::stat(folder_.c_str(), &status) != 0) refuse_folder(folder_, errno);
  if (!S_ISDIR(status.st_mode)) refuse_folder(folder_, ENOTDIR);
  if (::access(folder_.c_str(), W_OK | X_OK) != 0) refuse_folder(folder_, errno);
}

std::string TempDir::default_folder(const std::string& output_path) {
  if (const char* chosen = std::getenv("TMPDIR"); chosen != nullptr && *chosen != '\0') return chosen;
  const std::string parent = std::filesystem::path(output_path).parent_path().string();
  return parent.empty() ? "." : parent;
}

File TempDir::create_unnamed(const std::string& role) const {
  const std::string shown = folder_ + "/(temporary " + role + ")";
  int descriptor = ::open(folder_.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (descriptor < 0) {  // not every file system has files without a name
    std::string name = folder_ + "/reeb-XXXXXX";
    descriptor = ::mkostemp(name.data(), O_CLOEXEC);
    if (descriptor < 0) refuse_folder(folder_, errno);
    ::unlink(name.c_str());
  }
  return {descriptor, shown, fault_};
}

}  // namespace reeb::ooc
