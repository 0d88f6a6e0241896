#include "tools/program/output.h"

#include <algorithm>

#include "io/file/file_name.h"
#include "io/file/file_ostream.h"
#include "libreeb/base/printable.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {

void write_output(const std::string& path, bool force, const std::function<void(std::ostream&)>& write) {
  io::AtomicFile file(path.empty() ? io::kStandardOutput : path, {.existing = late_outputs(force)});
  io::FileOstream out(file.out());
  write(out);
  file.commit();
}

void note_other_suffix(const std::string& path, std::initializer_list<std::string_view> suffixes, const char* what) {
  const std::string suffix = io::name_suffix(path);
  if (suffix.empty() || std::ranges::find(suffixes, suffix) != suffixes.end()) return;
  print_line("note: " + printable(path) + " is " + what);
}

}  // namespace reeb::tools
