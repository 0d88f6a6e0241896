#include "io/mesh/sectioned_file.h"

#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"

namespace reeb::io {

SectionedFile::SectionedFile(const std::string& path, const MeshWriterOptions& options, std::size_t header_bytes)
    : file_(path, {.existing = options.existing, .overwrites = true}),
      temp_folder_(options.temp_folder.empty() ? TempDir::default_folder(path) : options.temp_folder),
      promised_(options.vertex_count) {
  file_.out().append(std::string(header_bytes, ' '));
}

BufferedWriter& SectionedFile::vertices(std::uint64_t count) {
  vertices_ += count;
  if (promised_ && vertices_ > *promised_)
    throw Error(ErrorKind::kBadInput,
                "the mesh has more than the " + std::to_string(*promised_) + " vertices that it announced",
                "check the input's header");
  return file_.out();
}

BufferedWriter& SectionedFile::faces(std::uint64_t count) {
  faces_ += count;
  // Once a face waits, all later faces wait too.
  if (!waiting_ && promised_ == vertices_) return file_.out();
  if (!waiting_) waiting_.emplace(TempDir(temp_folder_).create_unnamed("faces"));
  return *waiting_;
}

void SectionedFile::commit(const std::string& header) {
  if (waiting_) file_.out().append_file(*waiting_);
  file_.out().overwrite(0, header);
  file_.commit();
}

}  // namespace reeb::io
