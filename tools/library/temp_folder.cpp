#include "tools/library/temp_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"

namespace reeb {

TempFolder::TempFolder(const std::string& parent)
    : path_((parent.empty() ? io::TempDir::default_folder("") : parent) + "/reeb-again-XXXXXX") {
  if (::mkdtemp(path_.data()) == nullptr)
    throw Error(ErrorKind::kResource, std::string("cannot be created: ") + std::strerror(errno),
                "choose a folder that exists and is writable with --temp-dir DIR")
        .at(path_);
}

TempFolder::~TempFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace reeb
