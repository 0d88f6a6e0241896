#include "io/events/event_text.h"

#include <array>
#include <charconv>

#include "io/mesh/written_records.h"
#include "io/text/output_buffer.h"

namespace reeb::io {
namespace {

void append_real(std::string& out, double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 9).ptr;
  out.push_back(' ');
  out.append(text.data(), end);
}

template <class Integer>
void append_integer(std::string& out, Integer value) {
  std::array<char, 24> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  out.push_back(' ');
  out.append(text.data(), end);
}

void append_values(std::string& out, const StreamEvent& event, std::size_t floats, std::size_t ints) {
  for (std::size_t i = 0; i < floats; ++i) append_real(out, static_cast<double>(event.floats[i]));
  for (std::size_t i = 0; i < ints; ++i) append_integer(out, event.ints[i]);
}

// Its destructor writes the rest, so events before an error are written too.
class Lines {
 public:
  explicit Lines(std::ostream& out) : buffer_(out) {}
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;
  ~Lines() { buffer_.flush(); }

  std::string& text() {
    buffer_.flush_if_full();
    return buffer_.text();
  }

 private:
  OutputBuffer buffer_;
};

void append_batch_vertex(std::string& out, const MeshBatch& batch, std::size_t i) {
  out += 'v';
  append_integer(out, batch.first_vertex.value() + i);
  for (const auto& column : batch.coordinates) append_real(out, column[i]);
  for (const auto& column : batch.properties) append_real(out, column[i]);
  out += '\n';
}

void append_line(Lines& lines, char letter, std::span<const VertexId> vertices) {
  std::string& out = lines.text();
  out += letter;
  for (const VertexId v : vertices) append_integer(out, v.value());
  out += '\n';
}

}  // namespace

void append_event(std::string& out, const StreamEvent& event, const StreamHeader& header) {
  switch (event.kind) {
    case EventKind::kVertex:
      out += 'v';
      append_integer(out, event.vertex);
      append_values(out, event, header.vertex_floats, header.vertex_ints);
      break;
    case EventKind::kTriangle:
    case EventKind::kTetrahedron: {
      const bool triangle = event.kind == EventKind::kTriangle;
      out += triangle ? 't' : 'c';
      for (std::size_t k = 0; k < (triangle ? 3 : 4); ++k) append_integer(out, event.corners[k]);
      append_values(out, event, header.cell_floats, header.cell_ints);
      break;
    }
    case EventKind::kFinalized:
      out += 'f';
      append_integer(out, event.vertex);
      break;
  }
  out += '\n';
}

void write_events(EventReader& reader, std::ostream& out) {
  Lines lines(out);
  while (const StreamEvent* event = reader.next()) append_event(lines.text(), *event, reader.header());
}

void write_events(MeshReader& reader, std::ostream& out) {
  Lines lines(out);
  MeshBatch batch;
  while (reader.read(batch)) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) append_batch_vertex(lines.text(), batch, i);
    for_each_face(batch, 4, [&lines](std::span<const VertexId> corners) {
      if (corners.size() == 4)
        append_line(lines, 'c', corners);
      else
        append_line(lines, 't', as_triangle(corners));
    });
    for (const VertexId v : batch.finalized) append_line(lines, 'f', {&v, 1});
  }
}

}  // namespace reeb::io
