#include "tools/program/output.h"

#include <iostream>

#include "io/file/atomic_file.h"
#include "io/file/file_ostream.h"
#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

bool is_standard_output(const std::string& path) { return path.empty() || path == "-"; }

}  // namespace

void refuse_existing(const std::string& path, bool force) {
  if (is_standard_output(path)) return;
  io::check_output_name(path, force ? io::Existing::kReplace : io::Existing::kRefuse);
}

void write_output(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (!is_standard_output(path)) {
    io::AtomicFile file(path, {.existing = io::Existing::kReplace});
    io::FileOstream out(file.out());
    write(out);
    file.commit();
    return;
  }
  write(std::cout);
  if (!std::cout.flush())
    throw Error(ErrorKind::kResource, "standard output cannot be written", "write to a file with -o");
}

}  // namespace reeb::tools
