// SMC, versions 1 and 3. If several operations give the same triangle, this writer chooses as the programs of the
// format's authors do, so that files are the same byte for byte.
#include <algorithm>
#include <cmath>

#include "io/events/cell_hold.h"
#include "io/events/format_limits.h"
#include "io/events/stream_writer.h"
#include "io/smc/smc_head.h"
#include "io/smc/smc_positions.h"
#include "io/smc/smc_state.h"
#include "io/text/output_buffer.h"
#include "libreeb/base/count_text.h"
#include "libreeb/containers/flat_map.h"

namespace reeb::io {
namespace {

class SmcWriter : public StreamWriter {
 public:
  SmcWriter(std::ostream& out, const StreamHeader& header, const SmcOptions& options)
      : out_(out),
        version_(options.version),
        encoder_(after_version(out, version_)),
        positions_(options.precision, header.box),
        models_(options.version) {
    SmcHead head{options.precision, header.vertex_count, header.cell_count, {}, {}};
    if (header.box) {
      head.min = header.box->min;
      head.max = header.box->max;
    }
    code_smc_head(encoder_, head);
  }

  void write(const StreamEvent& event) override {
    switch (event.kind) {
      case EventKind::kVertex:
        return write_vertex(event);
      case EventKind::kTriangle:
        return write_triangle(event);
      case EventKind::kTetrahedron:
        return require_cell_kind(event.kind, false);
      case EventKind::kFinalized:
        return write_finalized(event.vertex);
    }
  }

  void close() override {
    code_held();
    if (state_.open_edges() == 0) {
      encoder_.code(models_.done, 1);
    } else {
      if (version_ == 1) fail_format("SMC version 1 cannot end with open edges", "write version 3 instead");
      encoder_.code(models_.operation[state_.context()], 0);
      encoder_.code(models_.old_corners, kEndOfStream);
    }
    encoder_.finish();
    out_.flush();
    isolated_ += slots_.size() - state_.active_count();
  }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> all;
    if (isolated_ > 0) all.push_back("left out: " + count_of(isolated_, "vertex") + " in no triangle");
    if (dropped_ > 0)
      all.push_back("left out: " + count_of(dropped_, "finalization") + " apart from the last triangle of the vertex");
    return all;
  }

 private:
  using Triangle = SmcState::Triangle;

  // The version byte comes before the stream of the range coder.
  static std::ostream& after_version(std::ostream& out, unsigned version) {
    return out.put(static_cast<char>(version));
  }
  static std::uint32_t symbol_of(bool yes) { return yes ? 1 : 0; }

  void write_vertex(const StreamEvent& event) {
    code_held();
    for (std::size_t k = 0; k < 3; ++k)
      if (!std::isfinite(event.floats[k]))
        fail_format("a coordinate of vertex " + std::to_string(event.vertex) + " is not finite", "fix the mesh first");
    const std::array<float, 3> xyz{event.floats[0], event.floats[1], event.floats[2]};
    slots_.find_or_insert(event.vertex, state_.create_vertex(event.vertex, positions_.to_coded(xyz)));
  }

  void write_triangle(const StreamEvent& event) {
    code_held();
    const auto& c = event.corners;
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
      fail_format("SMC cannot hold a triangle with a repeated corner (vertex " +
                      std::to_string(c[0] == c[1] ? c[0] : c[2]) + ")",
                  "write SMA or SMB, which hold degenerate triangles, edges and points; or drop them");
    for (std::size_t k = 0; k < 3; ++k)
      if (slots_.find(c[k]) == FlatMap::kNone)
        fail_format("vertex " + std::to_string(c[k]) + " is not active where a triangle names it",
                    "SMC needs every vertex before its triangles (pre-order)");
    held_.put(event);
  }

  void write_finalized(std::uint32_t vertex) {
    if (held_.finalize(vertex, false)) return;
    const std::uint32_t slot = slots_.find(vertex);
    if (slot == FlatMap::kNone) return;
    // A vertex that a triangle has used stays active; one without triangles is removed.
    if (state_.vertex(slot).uses > 0 || held_names(vertex)) {
      ++dropped_;
      return;
    }
    state_.drop_vertex(slot);
    slots_.erase(vertex);
    ++isolated_;
  }
  bool held_names(std::uint32_t vertex) const {
    const auto& corners = held_.cell().corners;
    return held_.full() && std::find(corners.begin(), corners.begin() + 3, vertex) != corners.begin() + 3;
  }

  static void rotate(Triangle& triangle, std::size_t first) {
    std::rotate(triangle.corners.begin(), triangle.corners.begin() + static_cast<std::ptrdiff_t>(first),
                triangle.corners.end());
    std::rotate(triangle.edges.begin(), triangle.edges.begin() + static_cast<std::ptrdiff_t>(first),
                triangle.edges.end());
  }

  bool visited(std::uint32_t slot) const { return state_.vertex(slot).uses > 0; }

  void code_held() {
    if (!held_.full()) return;
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle.corners[k] = slots_.find(held_.cell().corners[k]);
    code_triangle(triangle);
    code_finalizations(triangle);
    held_.clear();
  }

  void code_triangle(Triangle& triangle) {
    const auto& v = triangle.corners;
    std::uint32_t matches = 0, old = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      old += visited(v[i]);
      if (visited(v[i]) && visited(v[(i + 1) % 3])) triangle.edges[i] = state_.find_edge_from(v[i], v[(i + 1) % 3]);
      matches += triangle.edges[i] != kNone;
    }
    if (matches == 0)
      code_start(triangle, old);
    else if (matches == 1)
      code_edge(triangle, old == 2 ? SmcOperation::kAdd : SmcOperation::kJoin);
    else
      code_pair(triangle, matches);
  }

  // The operation is coded only if an edge is open; otherwise it is always a start.
  void code_operation(std::uint32_t symbol) {
    if (state_.open_edges() > 0)
      encoder_.code(models_.operation[state_.context()], symbol);
    else
      encoder_.code(models_.done, 0);
  }
  void code_active(std::uint32_t slot) { encoder_.uniform(state_.active_count(), state_.place_of(slot)); }
  void code_candidate(std::uint32_t slot, bool incoming, std::uint32_t edge) {
    const std::uint32_t count = state_.count_edges(slot, incoming);
    if (count > 1) encoder_.uniform(count, state_.rank_of_edge(slot, incoming, edge));
  }
  void code_new_vertex(std::uint32_t slot, const PredictionInput& from) {
    SmcVertex& vertex = state_.vertex(slot);
    vertex.position = positions_.code(encoder_, from, vertex.position);
    state_.append_active(slot);
  }

  void code_start(Triangle& triangle, std::uint32_t old) {
    const auto& v = triangle.corners;
    for (std::size_t turn = 0; turn < 3; ++turn) {  // old corners first
      if (old == 1 && visited(v[0])) break;
      if (old == 2 && !visited(v[2])) break;
      if (old == 0 || old == 3) break;
      rotate(triangle, 1);
    }
    code_operation(0);
    encoder_.code(models_.old_corners, old);
    for (std::size_t i = 0; i < 3; ++i) {
      if (i < old) {
        const std::uint32_t entry = state_.cache_entry(v[i]);
        encoder_.code(models_.start_cache[i], entry);
        if (entry == kStartEscape) code_active(v[i]);
        continue;
      }
      PredictionInput from;
      if (i > 0) from = {Prediction::kLast, &state_.vertex(v[0]).position, nullptr, nullptr};
      code_new_vertex(v[i], from);
    }
    state_.apply(triangle, SmcOperation::kStart);
  }

  void code_edge(Triangle& triangle, SmcOperation operation) {
    std::size_t side = 0;
    while (triangle.edges[side] == kNone) ++side;
    rotate(triangle, side);
    const auto [v0, v1, v2] = triangle.corners;
    const std::uint32_t e0 = triangle.edges[0];
    code_operation(static_cast<std::uint32_t>(operation));
    AdaptiveModel& cache = models_.edge_cache[state_.context()];
    const std::uint32_t at0 = state_.cache_entry(v0), at1 = state_.cache_entry(v1);
    const std::uint32_t symbol = at0 < 3 ? at0 : at1 < 3 ? 3 + at1 : kEdgeEscape;
    encoder_.code(cache, symbol);
    if (symbol == kEdgeEscape) code_active(v0);
    const bool by_v1 = at0 == 3 && at1 < 3;
    code_candidate(by_v1 ? v1 : v0, !by_v1, e0);
    if (operation == SmcOperation::kJoin) {
      code_active(v2);
    } else {
      code_new_vertex(
          v2, {Prediction::kAcross, &state_.vertex(v0).position, &state_.edge(e0).apex, &state_.vertex(v1).position});
    }
    state_.apply(triangle, operation);
  }

  void code_pair(Triangle& triangle, std::uint32_t matches) {
    rotate(triangle, pair_rotation(triangle, matches));
    const auto [v0, v1, v2] = triangle.corners;
    const auto [e0, e1, e2] = triangle.edges;
    code_operation(kFillSymbol);
    AdaptiveModel& cache = models_.pair_cache[state_.context()];
    const std::uint32_t at0 = state_.cache_entry(v0), at1 = state_.cache_entry(v1), at2 = state_.cache_entry(v2);
    if (at0 == 3 && at1 < 3) {
      encoder_.code(cache, 3 + at1);
      code_candidate(v1, false, e0);
      code_candidate(v0, false, e2);
    } else if (at0 == 3 && at2 < 3) {
      encoder_.code(cache, 6 + at2);
      code_candidate(v2, true, e2);
      code_candidate(v0, true, e0);
    } else {
      encoder_.code(cache, at0 < 3 ? at0 : kPairEscape);
      if (at0 == 3) code_active(v0);
      code_candidate(v0, true, e0);
      code_candidate(v0, false, e2);
    }
    // The decoder takes the first edge that closes the third side, so this one must too.
    if (matches == 3) triangle.edges[1] = state_.find_edge_to(v2, v1);
    state_.apply(triangle, matches == 3 ? SmcOperation::kEnd : SmcOperation::kFill);
  }

  // Returns which corner comes first: the side without an open edge, if any, must be side 1.
  std::size_t pair_rotation(const Triangle& triangle, std::uint32_t matches) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (matches == 2 && triangle.edges[i] == kNone) return (i + 2) % 3;
      if (matches == 3 && state_.cache_entry(triangle.corners[i]) < 3) return i;
    }
    return 0;
  }

  void code_finalizations(const Triangle& triangle) {
    for (const std::uint32_t slot : triangle.corners) {
      const SmcVertex& vertex = state_.vertex(slot);
      const bool final = held_final(vertex.index);
      const std::uint32_t index = vertex.index;
      encoder_.code(models_.final_at(vertex.edges.size, vertex.uses), symbol_of(final));
      if (!final) continue;
      state_.finalize(slot);
      slots_.erase(index);
    }
  }
  bool held_final(std::uint32_t vertex) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (held_.cell().corners[k] == vertex) return held_.is_final(k);
    return false;
  }

  OutputBuffer out_;
  unsigned version_;
  RangeEncoder encoder_;
  PositionCoder positions_;
  SmcModels models_;
  SmcState state_;
  FlatMap slots_;  // of vertices that arrived and are not final, by their number
  CellHold held_;
  std::uint64_t isolated_ = 0, dropped_ = 0;
};

}  // namespace

std::unique_ptr<StreamWriter> make_smc_writer(std::ostream& out, const StreamHeader& header,
                                              const SmcOptions& options) {
  return std::make_unique<SmcWriter>(out, header, options);
}

}  // namespace reeb::io
