#include "io/events/event_text.h"

#include "io/mesh/written_records.h"
#include "io/text/number_text.h"

namespace reeb::io {
namespace {

void append_values(std::string& out, const StreamEvent& event, std::size_t floats, std::size_t ints) {
  for (std::size_t i = 0; i < floats; ++i) append_field(out, event.floats[i]);
  for (std::size_t i = 0; i < ints; ++i) append_field(out, event.ints[i]);
}

void append_real(std::string& out, double value, bool float64) {
  if (float64)
    append_field(out, value);
  else
    append_field(out, static_cast<float>(value));
}

void append_batch_vertex(std::string& out, const MeshBatch& batch, std::size_t i, std::size_t properties,
                         bool float64) {
  out += 'v';
  append_field(out, batch.first_vertex.value() + i);
  for (const auto& column : batch.coordinates) append_real(out, column[i], float64);
  for (std::size_t k = 0; k < properties; ++k) append_real(out, batch.properties[k][i], float64);
  out += '\n';
}

void append_line(std::string& out, char letter, std::span<const VertexId> vertices) {
  out += letter;
  for (const VertexId v : vertices) append_field(out, v.value());
  out += '\n';
}

}  // namespace

void append_event(std::string& out, const StreamEvent& event, const StreamHeader& header) {
  switch (event.kind) {
    case EventKind::kVertex:
      out += 'v';
      append_field(out, event.vertex);
      append_values(out, event, header.vertex_floats, header.vertex_ints);
      break;
    case EventKind::kTriangle:
    case EventKind::kTetrahedron: {
      const bool triangle = event.kind == EventKind::kTriangle;
      out += triangle ? 't' : 'c';
      for (std::size_t k = 0; k < (triangle ? 3 : 4); ++k) append_field(out, event.corners[k]);
      append_values(out, event, header.cell_floats, header.cell_ints);
      break;
    }
    case EventKind::kFinalized:
      out += 'f';
      append_field(out, event.vertex);
      break;
  }
  out += '\n';
}

void write_events(OutputBuffer& out, const MeshBatch& batch, std::size_t properties, bool float64) {
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    append_batch_vertex(out.text(), batch, i, properties, float64);
    out.flush_if_full();
  }
  for_each_face(batch, 4, [&out](std::span<const VertexId> corners) {
    if (corners.size() == 4)
      append_line(out.text(), 'c', corners);
    else
      append_line(out.text(), 't', as_triangle(corners));
    out.flush_if_full();
  });
  for (const VertexId v : batch.finalized) {
    append_line(out.text(), 'f', {&v, 1});
    out.flush_if_full();
  }
}

}  // namespace reeb::io
