#include "io/formats/cx_writer.h"

#include "io/file/atomic_file.h"
#include "io/mesh/written_records.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

class CxWriter : public MeshWriter {
 public:
  CxWriter(const std::string& path, const MeshWriterOptions& options) : file_(path, {.existing = options.existing}) {}

  void write(const MeshBatch& batch) override {
    has_vertices_ |= batch.vertex_count != 0;
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      TextRecord line(file_.out());
      line.put('v');
      for (const auto& column : batch.coordinates) {
        line.put(' ');
        line.put(column[i]);
      }
      line.put('\n');
    }
    batch.for_each_simplex([this](std::span<const VertexId> corners) {
      TextRecord line(file_.out());
      line.put('s');
      for (const VertexId v : corners) {
        line.put(' ');
        line.put(v.value());
      }
      line.put('\n');
    });
  }

  // An empty file is taken for a damaged one.
  void close() override {
    if (!has_vertices_) file_.out().append("# no vertices\n");
    file_.commit();
  }

 private:
  AtomicFile file_;
  bool has_vertices_ = false;
};

}  // namespace

std::unique_ptr<MeshWriter> create_cx(const std::string& path, const MeshWriterOptions& options) {
  if (options.dimension == 0 || options.dimension > 9)
    throw Error(ErrorKind::kBadInput,
                "CX cannot hold vertices of " + std::to_string(options.dimension) + " coordinates", "write .off")
        .at(path);
  return std::make_unique<CxWriter>(path, options);
}

}  // namespace reeb::io
