#include "io/formats/sectioned_file.h"

#include "libreeb/base/error.h"

namespace reeb::io {

SectionedFile::SectionedFile(const std::string& path, Existing existing, std::size_t header_bytes,
                             std::optional<std::uint64_t> vertex_count)
    : file_(path, existing), promised_(vertex_count) {
  file_.out().append(std::string(header_bytes, ' '));
}

OutputFile& SectionedFile::vertices(std::uint64_t count) {
  vertices_ += count;
  if (promised_ && vertices_ > *promised_)
    throw Error(ErrorKind::kBadInput,
                "the mesh has more than the " + std::to_string(*promised_) + " vertices it promised",
                "check the input's header");
  return file_.out();
}

OutputFile& SectionedFile::faces(std::uint64_t count) {
  faces_ += count;
  // Once a face waits, all that follow wait behind it.
  if (!waiting_ && promised_ == vertices_) return file_.out();
  if (!waiting_) waiting_.emplace(open_nameless_file(file_.path()), file_.path());
  return *waiting_;
}

void SectionedFile::commit(const std::string& header) {
  if (waiting_) file_.out().append_file(*waiting_);
  file_.out().overwrite(0, header);
  file_.commit();
}

}  // namespace reeb::io
