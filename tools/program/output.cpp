#include "tools/program/output.h"

#include "io/file/file_ostream.h"

namespace reeb::tools {

void write_output(const std::string& path, bool force, const std::function<void(std::ostream&)>& write) {
  io::AtomicFile file(path.empty() ? io::kStandardOutput : path, {.existing = late_outputs(force)});
  io::FileOstream out(file.out());
  write(out);
  file.commit();
}

}  // namespace reeb::tools
