#include "io/file/temp_dir.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "io/file/system.h"
#include "libreeb/base/error.h"

namespace reeb::io {

namespace {

[[noreturn]] void refuse_folder(const std::string& folder, int error) {
  throw Error(ErrorKind::kResource, std::string("temporary files cannot be written there: ") + std::strerror(error),
              hint_for(error, "choose a folder that exists and is writable with --temp-dir DIR"))
      .at(folder);
}

}  // namespace

TempDir::TempDir(std::string folder) : folder_(folder.empty() ? default_folder("") : std::move(folder)) {
  const int probe = system::open_unnamed(folder_);
  if (probe < 0) refuse_folder(folder_, errno);
  ::close(probe);
}

std::string TempDir::default_folder(const std::string& output_path) {
  if (const char* chosen = std::getenv("TMPDIR"); chosen != nullptr && *chosen != '\0') return chosen;
  if (is_device(output_path)) return "/tmp";
  const std::string parent = std::filesystem::path(output_path).parent_path().string();
  if (!output_path.empty()) return parent.empty() ? "." : parent;
  // Nothing is written to the current folder, so it need not be writable.
  const int probe = system::open_unnamed(".");
  if (probe < 0) return "/tmp";
  ::close(probe);
  return ".";
}

File TempDir::create_unnamed(const std::string& role) const {
  const std::string shown = folder_ + "/(temporary " + role + ")";
  const int descriptor = system::open_unnamed(folder_);
  if (descriptor < 0) refuse_folder(folder_, errno);
  return {descriptor, shown, File::Use::kTemporary};
}

}  // namespace reeb::io
