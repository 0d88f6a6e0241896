#include "io/formats/off_writer.h"

#include "io/mesh/sectioned_file.h"
#include "io/mesh/written_records.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// More coordinates would not fit into one TextRecord.
constexpr unsigned kMaxWrittenDimension = 128;

class OffWriter : public MeshWriter {
 public:
  OffWriter(const std::string& path, const MeshWriterOptions& options)
      : dimension_(options.dimension),
        zero_(options.signed_zeros ? -0.0 : 0.0),
        header_bytes_(header(~std::uint64_t{0}, ~std::uint64_t{0}).size()),
        file_(path, options, header_bytes_) {}

  void write(const MeshBatch& batch) override {
    BufferedWriter& out = file_.vertices(batch.vertex_count);
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      TextRecord line(out);
      for (unsigned k = 0; k < dimension_; ++k) {
        line.put_signed(batch.coordinates[k][i] + zero_);
        line.put(k + 1 < dimension_ ? ' ' : '\n');
      }
    }
    if (const std::uint64_t faces = face_count(batch); faces != 0) write_faces(batch, faces);
  }

  void close() override {
    std::string text = header(file_.vertex_count(), file_.face_count());
    // Blanks at the end of the line fill the room that was reserved for longer counts.
    text.insert(text.size() - 1, header_bytes_ - text.size(), ' ');
    file_.commit(text);
  }

 private:
  std::string header(std::uint64_t vertices, std::uint64_t faces) const {
    const std::string magic = dimension_ == 3 ? "OFF\n" : "nOFF\n" + std::to_string(dimension_) + "\n";
    return magic + std::to_string(vertices) + " " + std::to_string(faces) + " 0\n";
  }

  void write_faces(const MeshBatch& batch, std::uint64_t count) {
    BufferedWriter& out = file_.faces(count);
    for_each_face(batch, 3, [&out](std::span<const VertexId> corners) {
      TextRecord line(out);
      line.put(corners.size());
      for (const VertexId v : corners) {
        line.put(' ');
        line.put(v.value());
      }
      line.put('\n');
    });
  }

  unsigned dimension_;
  double zero_;  // is added to each number: 0.0 makes 0.0 of -0.0, and -0.0 changes nothing
  std::size_t header_bytes_;
  SectionedFile file_;
};

}  // namespace

std::unique_ptr<MeshWriter> create_off(const std::string& path, const MeshWriterOptions& options) {
  if (options.dimension == 0 || options.dimension > kMaxWrittenDimension)
    throw Error(ErrorKind::kBadInput,
                "OFF cannot be written with " + std::to_string(options.dimension) + " coordinates per vertex",
                "write .ply")
        .at(path);
  return std::make_unique<OffWriter>(path, options);
}

}  // namespace reeb::io
