#include "tests/fuzz/legality.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace reeb::io {
namespace {

void mix(std::uint64_t& digest, std::uint64_t value) {
  digest = (digest ^ value) * 0x9e3779b97f4a7c15ULL;
  digest ^= digest >> 29;
}

}  // namespace

void violation(const std::string& what) {
  std::fprintf(stderr, "broken promise: %s\n", what.c_str());
  std::abort();
}

void expect(bool holds, const char* promise) {
  if (!holds) violation(promise);
}

void expect_helpful(const Error& error) {
  if (error.kind() != ErrorKind::kBadInput || error.message().empty() || error.hint().empty() || error.file().empty())
    violation(std::string("an error without file or hint, or of another kind: ") + error.what());
}

void BatchLegality::add(const MeshBatch& batch, const MeshInfo& info, std::size_t properties) {
  expect(!batch.empty(), "a batch is not empty");
  expect(batch.first_vertex.value() == delivered_.vertices, "vertices are numbered without gaps");
  expect(batch.coordinates.size() == info.dimension, "there is a column for each coordinate");
  expect(batch.properties.size() == properties, "there is a column for each property that was asked for");
  add_vertices(batch);
  for (std::size_t k = 0; k < batch.simplices.size(); ++k) add_simplices(batch.simplices[k], k + 1);
  for (const VertexId v : batch.finalized) {
    expect(v.value() < delivered_.vertices, "a final vertex has arrived");
    expect(!final_[v.value()], "a vertex becomes final once");
    final_[v.value()] = true;
    ++delivered_.finalized;
    mix(delivered_.final_digest, v.value());
  }
}

void BatchLegality::add_vertices(const MeshBatch& batch) {
  for (const auto* columns : {&batch.coordinates, &batch.properties})
    for (const auto& column : *columns)
      expect(column.size() == batch.vertex_count, "columns are as long as vertices are many");
  for (std::size_t i = 0; i < batch.vertex_count; ++i)
    for (const auto& column : batch.coordinates) {
      expect(std::isfinite(column[i]), "coordinates are finite");
      mix(delivered_.vertex_digest, std::bit_cast<std::uint64_t>(column[i]));
    }
  delivered_.vertices += batch.vertex_count;
  final_.resize(delivered_.vertices);
}

void BatchLegality::add_simplices(const std::vector<VertexId>& corners, std::size_t corners_each) {
  expect(corners.size() % corners_each == 0, "simplices have all their corners");
  for (const VertexId v : corners) {
    expect(v.value() < delivered_.vertices, "a corner has arrived");
    expect(!final_[v.value()], "a corner is not final");
    mix(delivered_.simplex_digests[corners_each - 1], v.value());
  }
  delivered_.simplices += corners.size() / corners_each;
}

void EventLegality::add(const StreamEvent& event, const StreamHeader& header) {
  switch (event.kind) {
    case EventKind::kVertex:
      expect(event.vertex == final_.size(), "vertices are numbered without gaps");
      for (std::size_t k = 0; k < header.vertex_floats; ++k)
        expect(std::isfinite(event.floats[k]), "values of vertices are finite");
      final_.push_back(false);
      return;
    case EventKind::kTriangle:
    case EventKind::kTetrahedron:
      expect((event.kind == EventKind::kTetrahedron) == header.volume, "cells are of the kind of the file");
      for (std::size_t k = 0; k < (header.volume ? 4 : 3); ++k) {
        const std::uint32_t v = event.corners[k];
        expect(header.post_order == (v >= final_.size()), "in pre-order vertices come first, in post-order last");
        expect(header.post_order || !final_[v], "a corner is not final");
        named_end_ = std::max<std::uint64_t>(named_end_, v + std::uint64_t{1});
      }
      ++cells_;
      return;
    case EventKind::kFinalized:
      expect(event.vertex < final_.size(), "a final vertex has arrived");
      expect(!final_[event.vertex], "a vertex becomes final once");
      final_[event.vertex] = true;
      return;
  }
}

void EventLegality::end() const { expect(named_end_ <= final_.size(), "every vertex that is named arrives"); }

}  // namespace reeb::io
