#include "io/formats/off_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "io/mesh/batch_reader.h"
#include "io/mesh/scalar_bytes.h"
#include "io/mesh/simplex_assembler.h"
#include "io/text/cursor.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// More coordinates than any mesh has: a header that announces more is damaged.
constexpr std::int64_t kMaxDimension = 1024;
constexpr const char* kOffHeaderHint = "the OFF header is damaged; write the file again";

struct OffHeader {
  OffKind kind;
  std::string keyword;
  unsigned dimension = 3;
  std::uint64_t vertices = 0, faces = 0;
};

unsigned dimension_of(const OffKind& kind, std::int64_t declared) {
  return static_cast<unsigned>(kind.any_dimension ? declared : 3) + (kind.four ? 1 : 0);
}

// Refuses counts for which the rest of the input is too short, if its size is known.
void check_counts(const OffHeader& header, const ContentSource& source, std::uint64_t offset,
                  std::uint64_t vertex_bytes, std::uint64_t face_bytes, const std::string& position) {
  const auto size = source.size();
  if (!size) return;
  const std::uint64_t left = *size - std::min(offset, *size) + 1;  // the last line end may be missing
  const bool vertices_fit = header.vertices <= left / vertex_bytes;
  if (vertices_fit && header.faces <= (left - header.vertices * vertex_bytes) / face_bytes) return;
  throw Error(ErrorKind::kBadInput,
              "the header announces " + count_of(header.vertices, "vertex") + " and " + count_of(header.faces, "face") +
                  ", more than the file has room for",
              kCutOrHeaderHint)
      .at(source.name(), position);
}

class OffReader : public BatchReader {
 protected:
  explicit OffReader(ReadOptions options) : BatchReader(std::move(options)) {}

  void describe(const OffHeader& header, const ContentSource& source) {
    header_ = header;
    refuse_properties(options(), "OFF", source.name());
    info_.format = header.keyword + (header.kind.binary ? " binary" : "");
    info_.dimension = header.dimension;
    info_.vertex_count = header.vertices;
    info_.simplex_count = header.faces;
    info_.file_bytes = source.file_bytes();
  }

  void fill(MeshBatch& batch) final {
    while (room(batch) != 0 && vertices_read() != header_.vertices) {
      read_vertex(batch);
      count_vertices(batch, 1);
    }
    while (room(batch) != 0 && faces_read_ != header_.faces)
      if (!in_face_ && read_plain_triangle(header_.vertices, batch))
        ++faces_read_;
      else
        advance_face(batch);
    if (vertices_read() == header_.vertices && faces_read_ == header_.faces) trailing_ = has_more();
  }

  std::vector<std::string> warnings() const override {
    if (!trailing_) return {};
    return {"what follows the last face was ignored: the header does not announce it"};
  }

  virtual void read_vertex(MeshBatch& batch) = 0;
  // Reads a triangle with corners below `limit` at once. Returns false if the face has another form or is wrong.
  virtual bool read_plain_triangle(std::uint64_t, MeshBatch&) { return false; }
  virtual std::int64_t begin_face() = 0;  // returns the number of corners
  virtual std::int64_t read_corner() = 0;
  virtual void end_face() = 0;
  virtual bool has_more() = 0;
  [[noreturn]] virtual void fail(const std::string& what, const std::string& hint) const = 0;

  OffHeader header_;

 private:
  void advance_face(MeshBatch& batch) {
    if (!std::exchange(in_face_, true)) {
      corners_left_ = begin_face();
      if (corners_left_ < 0) fail("a face has a negative number of corners", kOffHeaderHint);
      face_.begin(FaceShape::kPolygon);
    }
    if (corners_left_ != 0) {
      --corners_left_;
      const std::int64_t corner = read_corner();
      if (corner < 0 || static_cast<std::uint64_t>(corner) >= header_.vertices)
        fail("a face names vertex " + std::to_string(corner) + ", but the mesh has only " +
                 count_of(header_.vertices, "vertex"),
             "vertices are numbered from 0; the file may be damaged here");
      face_.add(VertexId(static_cast<std::uint64_t>(corner)), batch);
      return;
    }
    face_.end(batch);
    end_face();
    in_face_ = false;
    ++faces_read_;
  }

  SimplexAssembler face_;
  std::uint64_t faces_read_ = 0;
  bool in_face_ = false, trailing_ = false;
  std::int64_t corners_left_ = 0;
};

// Usually one vertex or face a line; either may also run over several lines. The rest of its last line (normals,
// colours) is skipped.
class AsciiOffReader final : public OffReader {
 public:
  AsciiOffReader(TextCursor text, OffHeader header, ReadOptions options)
      : OffReader(std::move(options)), text_(std::move(text)) {
    if (header.kind.any_dimension) {
      const std::int64_t declared = header_integer();
      if (declared < 1 || declared > kMaxDimension)
        text_.fail("a mesh of dimension " + std::to_string(declared), kOffHeaderHint);
      header.dimension = dimension_of(header.kind, declared);
    }
    header.vertices = count();
    const std::uint64_t line = text_.line();
    header.faces = count();
    // The number of edges, which is often wrong, and often missing. It may be on a line of its own if the others are.
    const bool apart = text_.line() != line && !text_.more_on_line();
    text_.skip_line();
    if (apart && header.dimension > 1 && text_.more())
      text_.plain_line([](PlainLine& numbers) {
        std::uint64_t edges = 0;
        return numbers.integer(edges);
      });
    check_counts(header, text_.source(), text_.bytes().offset(), std::uint64_t{2} * header.dimension, 2,
                 text_.position());
    describe(header, text_.source());
    if (this->options().signed_zeros) text_.keep_signed_zeros();
  }

  std::uint64_t bytes_read() const override { return text_.bytes_read(); }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> lines = OffReader::warnings();
    if (non_finite_values_ != 0)
      lines.push_back(count_of(non_finite_values_, "value") + " of normals or colours " +
                      (non_finite_values_ == 1 ? "is" : "are") + " not finite (they are not used)");
    return lines;
  }

 private:
  std::int64_t header_integer() {
    text_.require_more("count");
    return text_.integer("count");
  }
  std::uint64_t count() {
    const std::int64_t value = header_integer();
    if (value < 0) text_.fail("a count is negative", kOffHeaderHint);
    return static_cast<std::uint64_t>(value);
  }

  void read_vertex(MeshBatch& batch) override {
    if (header_.dimension == 3 && read_plain_point(batch)) return;
    for (auto& column : batch.coordinates) {
      text_.require_more("coordinate");
      column.push_back(text_.finite_number<double>("coordinate"));
    }
    while (text_.more_on_line()) non_finite_values_ += spells_non_finite(text_.token()) ? 1u : 0u;
    text_.skip_line();
  }
  // Returns false if the line is not only three numbers.
  bool read_plain_point(MeshBatch& batch) {
    std::array<double, 3> point{};
    if (!text_.plain_line([&](PlainLine& line) { return line.point(point); })) return false;
    for (std::size_t k = 0; k < 3; ++k) batch.coordinates[k].push_back(point[k]);
    return true;
  }
  bool read_plain_triangle(std::uint64_t limit, MeshBatch& batch) override {
    std::array<std::uint64_t, 3> corners;
    if (!text_.plain_line([&](PlainLine& line) { return line.triangle(limit, corners); })) return false;
    for (const std::uint64_t corner : corners) batch.triangles().push_back(VertexId(corner));
    return true;
  }
  std::int64_t begin_face() override { return number("number of corners"); }
  std::int64_t read_corner() override { return number("vertex index"); }
  void end_face() override { text_.skip_line(); }
  bool has_more() override { return text_.more(); }
  void fail(const std::string& what, const std::string& hint) const override { text_.fail(what, hint); }

  std::int64_t number(const char* what) {
    text_.require_more(what);
    text_.mark();
    std::uint64_t value = 0;
    if (!text_.digits(value)) return text_.integer(what);
    if (const char next = text_.peek(); next != '\n' && next != '#' && !is_blank(next))
      text_.fail(std::string("a ") + what + " is not an integer", kDamagedHereHint);
    return static_cast<std::int64_t>(value);
  }

  TextCursor text_;
  std::uint64_t non_finite_values_ = 0;
};

class BinaryOffReader final : public OffReader {
 public:
  BinaryOffReader(Cursor cursor, OffHeader header, ReadOptions options)
      : OffReader(std::move(options)), cursor_(std::move(cursor)) {
    if (header.kind.any_dimension) {
      const std::int64_t declared = integer();
      if (declared < 1 || declared > kMaxDimension)
        fail("a mesh of dimension " + std::to_string(declared), kOffHeaderHint);
      header.dimension = dimension_of(header.kind, declared);
    }
    header.vertices = count();
    header.faces = count();
    const std::string position = std::to_string(taken_);
    count();  // of edges
    vertex_numbers_ = header.dimension + header.kind.extra_numbers(header.dimension);
    check_counts(header, cursor_.source(), cursor_.offset(), 4 * vertex_numbers_, 8, position);
    describe(header, cursor_.source());
  }

  std::uint64_t bytes_read() const override { return cursor_.bytes_read(); }

 private:
  const char* take(std::size_t size) {
    taken_ = cursor_.offset();
    if (!cursor_.ensure(size)) {
      taken_ += cursor_.available();
      fail("the file ends before its last face", kCutHint);
    }
    const char* const bytes = cursor_.data();
    cursor_.advance(size);
    return bytes;
  }
  std::int64_t integer() { return load_scalar<std::int32_t>(take(4), true); }
  std::uint64_t count() {
    const std::int64_t value = integer();
    if (value < 0) fail("a count is negative", kOffHeaderHint);
    return static_cast<std::uint64_t>(value);
  }

  void read_vertex(MeshBatch& batch) override {
    const char* const bytes = take(4 * vertex_numbers_);
    for (std::size_t k = 0; k < header_.dimension; ++k) {
      const float value = load_scalar<float>(bytes + 4 * k, true);
      if (!std::isfinite(value)) {
        taken_ += 4 * k;
        fail("a coordinate is not finite", "fix this vertex, or remove it");
      }
      batch.coordinates[k].push_back(static_cast<double>(value) + zero());
    }
  }
  std::int64_t begin_face() override { return integer(); }
  std::int64_t read_corner() override { return integer(); }
  void end_face() override {
    for (std::uint64_t components = count(); components != 0; --components) take(4);
  }
  bool has_more() override { return !cursor_.at_end(); }
  void fail(const std::string& what, const std::string& hint) const override {
    throw Error(ErrorKind::kBadInput, what, hint).at(cursor_.source().name(), std::to_string(taken_));
  }

  Cursor cursor_;
  std::size_t vertex_numbers_ = 0;
  std::uint64_t taken_ = 0;
};

}  // namespace

std::optional<OffKind> parse_off_keyword(std::string_view word) {
  OffKind kind;
  const auto accept = [&word](std::string_view prefix) {
    if (!word.starts_with(prefix)) return false;
    word.remove_prefix(prefix.size());
    return true;
  };
  kind.texture = accept("ST");
  kind.colours = accept("C");
  kind.normals = accept("N");
  kind.four = accept("4");
  kind.any_dimension = accept("n");
  if (word != "OFF") return std::nullopt;
  return kind;
}

std::unique_ptr<MeshReader> open_off(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  TextCursor text(std::move(source), {.comments = true});
  OffHeader header;
  text.more();
  header.keyword = text.token();
  const auto kind = parse_off_keyword(header.keyword);
  if (!kind) text.fail("an OFF file begins with the word OFF", kOffHeaderHint);
  header.kind = *kind;
  header.dimension = dimension_of(header.kind, 3);
  if (text.more_on_line() && text.peek() == 'B') {
    if (text.token() != "BINARY") text.fail("only the word BINARY may be here", kOffHeaderHint);
    header.kind.binary = true;
    text.skip_line();
    return std::make_unique<BinaryOffReader>(std::move(text.bytes()), header, options);
  }
  return std::make_unique<AsciiOffReader>(std::move(text), header, options);
}

}  // namespace reeb::io
