#include "io/formats/obj_writer.h"

#include "io/file/atomic_file.h"
#include "io/mesh/written_records.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

class ObjWriter : public MeshWriter {
 public:
  ObjWriter(const std::string& path, const MeshWriterOptions& options)
      : dimension_(options.dimension),
        zero_(options.signed_zeros ? -0.0 : 0.0),
        file_(path, {.existing = options.existing}) {}

  void write(const MeshBatch& batch) override {
    has_vertices_ |= batch.vertex_count != 0;
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      TextRecord line(file_.out());
      line.put('v');
      for (unsigned k = 0; k < 3; ++k) {
        line.put(' ');
        line.put_signed(k < dimension_ ? batch.coordinates[k][i] + zero_ : 0.0);
      }
      line.put('\n');
    }
    for_each_face(batch, 3, [this](std::span<const VertexId> corners) {
      TextRecord line(file_.out());
      line.put("plf"[corners.size() - 1]);
      for (const VertexId v : corners) {
        line.put(' ');
        line.put(v.value() + 1);
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
  unsigned dimension_;
  double zero_;  // is added to each number: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing
  AtomicFile file_;
  bool has_vertices_ = false;
};

}  // namespace

std::unique_ptr<MeshWriter> create_obj(const std::string& path, const MeshWriterOptions& options) {
  if (options.dimension > 3)
    throw Error(ErrorKind::kBadInput,
                "OBJ cannot hold vertices of " + std::to_string(options.dimension) + " coordinates",
                "write .ply or .off")
        .at(path);
  return std::make_unique<ObjWriter>(path, options);
}

}  // namespace reeb::io
