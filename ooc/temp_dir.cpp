#include "ooc/temp_dir.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
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

TempDir::~TempDir() {
  std::error_code ignored;  // a destructor cannot do better than leave what cannot be removed
  if (!path_.empty() && !keep_) std::filesystem::remove_all(path_, ignored);
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

File TempDir::create_named(const std::string& name) {
  const std::string file = path() + "/" + name;
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (descriptor < 0) refuse_folder(file, errno);
  return {descriptor, file, fault_};
}

const std::string& TempDir::path() {
  const std::lock_guard lock(mutex_);
  if (path_.empty()) {
    std::string name = folder_ + "/reeb-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) refuse_folder(folder_, errno);
    path_ = std::move(name);
  }
  return path_;
}

}  // namespace reeb::ooc
