#include "io/smc/smc_reader.h"

#include "io/events/index_rules.h"
#include "io/events/stream_fault.h"
#include "io/smc/smc_head.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kEventsPerFill = 128;

unsigned version_byte(Cursor& cursor) {
  cursor.ensure(1);
  const auto version = static_cast<unsigned char>(*cursor.data());
  cursor.advance(1);
  return version;
}

// "CORRUPT: what" becomes "CORRUPT: triangle 133: what", at the position of the decoder.
Error located(const Error& error, const std::string& triangle, const char* note, std::uint64_t position) {
  const std::size_t end = error.message().find(": ") + 2;
  Error result(error.kind(), error.message().substr(0, end) + triangle + error.message().substr(end) + note,
               error.hint());
  result.at({}, error.position().empty() ? std::to_string(position) : error.position());
  return result;
}

}  // namespace

// Runs a part of the decoding, and adds the position to its faults.
template <class Action>
void SmcEventReader::guarded(Action action) {
  try {
    action();
  } catch (const Error& error) {
    const std::string triangle = positions_ ? "triangle " + std::to_string(triangles_) + ": " : "";
    throw located(error, triangle, version_ == 1 ? " (or an old SMC file of 2003)" : "",
                  decoder_ ? decoder_->position() : cursor_.offset());
  }
}

SmcEventReader::SmcEventReader(Cursor cursor)
    : version_(version_byte(cursor)), cursor_(std::move(cursor)), models_(version_) {
  header_.format = "SMC version " + std::to_string(version_);
  guarded([this] {
    decoder_.emplace(cursor_);
    SmcHead head;
    code_smc_head(*decoder_, head);
    header_.vertex_count = head.vertex_count;
    header_.cell_count = head.cell_count;
    header_.box = head.box();
    positions_.emplace(head.precision, header_.box);
  });
}

void SmcEventReader::fill() {
  guarded([this] {
    while (!done_ && queued() < kEventsPerFill)
      if (!read_triangle()) finish();
  });
}

bool SmcEventReader::read_triangle() {
  std::uint32_t operation = 0;
  if (state_.open_edges() > 0)
    operation = decoder_->code(models_.operation[state_.context()]);
  else if (decoder_->bit(models_.done))
    return false;

  SmcState::Triangle triangle;
  new_vertices_ = 0;
  auto applied = static_cast<SmcOperation>(operation);
  if (applied == SmcOperation::kStart) {
    if (!read_start(triangle)) return false;
  } else if (operation == kFillSymbol) {
    applied = read_pair(triangle);
  } else {
    read_edge(triangle, applied);
  }
  deliver(triangle, applied);
  return true;
}

std::uint32_t SmcEventReader::read_active() {
  if (state_.active_count() == 0) fail(Fault::kCorrupt, "there is no active vertex", {});
  return state_.active_at(decoder_->uniform(state_.active_count()));
}

std::uint32_t SmcEventReader::read_cached(std::size_t entry) const {
  const std::uint32_t slot = state_.cached(entry);
  if (slot == kNone) fail(Fault::kCorrupt, "cache entry " + std::to_string(entry) + " is not an active vertex", {});
  return slot;
}

std::uint32_t SmcEventReader::read_edge_at(std::uint32_t slot, bool incoming) {
  const std::uint32_t count = state_.count_edges(slot, incoming);
  if (count == 0)
    fail(Fault::kCorrupt, "vertex " + std::to_string(state_.vertex(slot).index) + " has no open edge that fits", {});
  return state_.pick_edge(slot, incoming, count > 1 ? decoder_->uniform(count) : 0);
}

void SmcEventReader::read_new_vertex(SmcState::Triangle& triangle, std::size_t corner, const PredictionInput& from) {
  if (vertices_ + new_vertices_ == kMaxVertices) fail(Fault::kBadIndex, "more than 2147483647 vertices", {});
  const CodedPosition position = positions_->code(*decoder_, from, {});
  const std::uint32_t slot = state_.create_vertex(vertices_ + new_vertices_++, position);
  triangle.corners[corner] = slot;
  state_.append_active(slot);
}

bool SmcEventReader::read_start(SmcState::Triangle& triangle) {
  const std::uint32_t old = decoder_->code(models_.old_corners);
  if (old == kEndOfStream) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i < old) {
      const std::uint32_t entry = decoder_->code(models_.start_cache[i]);
      triangle.corners[i] = entry < kStartEscape ? read_cached(entry) : read_active();
      continue;
    }
    PredictionInput from;
    CodedPosition first;
    if (i > 0) {
      first = state_.vertex(triangle.corners[0]).position;
      from = {Prediction::kLast, &first, nullptr, nullptr};
    }
    read_new_vertex(triangle, i, from);
  }
  return true;
}

void SmcEventReader::read_edge(SmcState::Triangle& triangle, SmcOperation operation) {
  auto& [v0, v1, v2] = triangle.corners;
  std::uint32_t& e0 = triangle.edges[0];
  const std::uint32_t symbol = decoder_->code(models_.edge_cache[state_.context()]);
  if (symbol < 3 || symbol == kEdgeEscape) {
    v0 = symbol < 3 ? read_cached(symbol) : read_active();
    e0 = read_edge_at(v0, true);
    v1 = state_.edge(e0).origin;
  } else {
    v1 = read_cached(symbol - 3);
    e0 = read_edge_at(v1, false);
    v0 = state_.edge(e0).target;
  }
  if (operation == SmcOperation::kJoin) {
    v2 = read_active();
    return;
  }
  const CodedPosition a = state_.vertex(v0).position, b = state_.edge(e0).apex, c = state_.vertex(v1).position;
  read_new_vertex(triangle, 2, {Prediction::kAcross, &a, &b, &c});
}

SmcOperation SmcEventReader::read_pair(SmcState::Triangle& triangle) {
  auto& [v0, v1, v2] = triangle.corners;
  auto& [e0, e1, e2] = triangle.edges;
  const std::uint32_t symbol = decoder_->code(models_.pair_cache[state_.context()]);
  if (symbol < 3 || symbol == kPairEscape) {
    v0 = symbol < 3 ? read_cached(symbol) : read_active();
    e0 = read_edge_at(v0, true);
    v1 = state_.edge(e0).origin;
    e2 = read_edge_at(v0, false);
    v2 = state_.edge(e2).target;
  } else if (symbol < 6) {
    v1 = read_cached(symbol - 3);
    e0 = read_edge_at(v1, false);
    v0 = state_.edge(e0).target;
    e2 = read_edge_at(v0, false);
    v2 = state_.edge(e2).target;
  } else {
    v2 = read_cached(symbol - 6);
    e2 = read_edge_at(v2, true);
    v0 = state_.edge(e2).origin;
    e0 = read_edge_at(v0, true);
    v1 = state_.edge(e0).origin;
  }
  e1 = state_.find_edge_to(v2, v1);
  return e1 == kNone ? SmcOperation::kFill : SmcOperation::kEnd;
}

void SmcEventReader::deliver(const SmcState::Triangle& triangle, SmcOperation operation) {
  const auto& corners = triangle.corners;
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
    fail(Fault::kCorrupt, "two corners are the same vertex", {});
  // New vertices are the last corners, in the order in which they were decoded.
  for (std::size_t i = 3 - new_vertices_; i < 3; ++i) {
    const SmcVertex& vertex = state_.vertex(corners[i]);
    const auto position = positions_->to_position(vertex.position);
    StreamEvent& event = push(EventKind::kVertex);
    event.vertex = vertex.index;
    std::copy(position.begin(), position.end(), event.floats.begin());
  }
  vertices_ += new_vertices_;
  StreamEvent& event = push(EventKind::kTriangle);
  for (std::size_t i = 0; i < 3; ++i) event.corners[i] = state_.vertex(corners[i]).index;
  state_.apply(triangle, operation);
  for (const std::uint32_t slot : corners) {
    const SmcVertex& vertex = state_.vertex(slot);
    if (!decoder_->bit(models_.final_at(vertex.edges.size, vertex.uses))) continue;
    push_finalized(vertex.index);
    state_.finalize(slot);
  }
  ++triangles_;
}

void SmcEventReader::finish() {
  done_ = true;
  decoder_->finish();
  for (auto text : {count_warning({header_.vertex_count, vertices_}, "vertices", true),
                    count_warning({header_.cell_count, triangles_}, "triangles", true)})
    if (!text.empty()) warn(std::move(text));
  if (!cursor_.at_end()) warn("TRAIL: bytes after the end of the code stream are ignored");
}

}  // namespace reeb::io
