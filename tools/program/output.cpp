#include "tools/program/output.h"

#include <filesystem>
#include <iostream>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

bool is_standard_output(const std::string& path) { return path.empty() || path == "-"; }

}  // namespace

void refuse_existing(const std::string& path, bool force) {
  std::error_code ignored;
  if (force || is_standard_output(path) || !std::filesystem::exists(path, ignored)) return;
  throw Error(ErrorKind::kBadInput, "the output exists", "choose another name, or overwrite it with --force").at(path);
}

void write_output(const std::string& path, const std::function<void(std::ostream&)>& write) {
  if (!is_standard_output(path)) {
    io::AtomicOutput out(path);
    write(out);
    out.commit();
    return;
  }
  write(std::cout);
  if (!std::cout.flush())
    throw Error(ErrorKind::kResource, "standard output cannot be written", "write to a file with -o");
}

}  // namespace reeb::tools
