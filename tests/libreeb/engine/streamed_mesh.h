// Generated meshes of some thousand triangles, streamed in chunks through sweep and glue.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "io/generate/generator.h"
#include "libreeb/base/hash.h"
#include "libreeb/engine/glue.h"
#include "libreeb/engine/stream_chunker.h"
#include "libreeb/sweep/chunk_sweep.h"

namespace reeb::test {

enum class Function { kY, kZ, kRandom };

struct Mesh {
  std::vector<double> values;
  std::vector<Point> positions;
  std::vector<VertexId> corners;
  std::vector<std::size_t> last_use;  // by vertex: the index of its last corner
  std::uint64_t max_loops = 0;
};

inline Mesh make_mesh(io::MeshKind kind, io::MeshOrder order, Function function) {
  io::GeneratorOptions options;
  options.kind = kind;
  options.order = order;
  options.triangles = 30'000;
  const auto reader = io::generate_mesh(options);
  Mesh mesh;
  mesh.max_loops = reader->topology().max_reeb_loops;
  for (MeshBatch batch; reader->read(batch);) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      mesh.positions.push_back({batch.coordinates[0][i], batch.coordinates[1][i], batch.coordinates[2][i]});
      mesh.values.push_back(function == Function::kRandom ? static_cast<double>(mix(mesh.values.size()) >> 11)
                                                          : batch.coordinates[function == Function::kY ? 1 : 2][i]);
    }
    mesh.corners.insert(mesh.corners.end(), batch.triangles().begin(), batch.triangles().end());
  }
  mesh.last_use.assign(mesh.values.size(), 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) mesh.last_use[mesh.corners[i].value()] = i;
  return mesh;
}

struct KeepingSink : GraphSink {
  void add_nodes(std::span<const SettledNode> more) override {
    for (const SettledNode& node : more) nodes.push_back(node.key);
  }
  void add_arcs(const SettledArcs& more) override { arcs.insert(arcs.end(), more.arcs.begin(), more.arcs.end()); }
  ReebGraph graph() const { return make_graph(arcs, nodes); }

  std::vector<SweepKey> nodes;
  std::vector<ArcKeys> arcs;
};

// Streams the mesh in chunks of this number of triangles. options_of(min, max) returns the options of a chunk, for the
// range of the values up to its end; between_chunks(glue) is called after each chunk. `overstated`: every third vertex
// is marked as used earlier, whether it is or not. Returns the number of removed pairs.
template <class OptionsOf, class BetweenChunks>
std::uint64_t stream(const Mesh& mesh, std::size_t size, GraphSink& sink, const OptionsOf& options_of,
                     const BetweenChunks& between_chunks, bool overstated = false) {
  StreamChunker chunker(1, true);
  ChunkSweep sweep;
  Glue glue(sink, true);
  Chunk chunk;
  std::vector<std::vector<double>> values;
  Fragment fragment;
  double min = std::numeric_limits<double>::max(), max = -min;
  const auto flush = [&] {
    chunker.take(chunk, values);
    for (std::size_t v = 0; overstated && v < chunk.vertex_count(); v += 3) chunk.uses[v] |= kUsedEarlier;
    for (const double value : values[0]) {
      min = std::min(min, value);
      max = std::max(max, value);
    }
    sweep.run(chunk, values[0], fragment, options_of(min, max));
    glue.add(fragment);
    glue.graph().validate();
    between_chunks(glue);
  };
  for (std::size_t v = 0; v < mesh.values.size(); ++v) chunker.add_vertex({&mesh.values[v], 1}, mesh.positions[v]);
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    chunker.add_simplex({&mesh.corners[i], 3});
    for (std::size_t k = i; k < i + 3; ++k)
      if (mesh.last_use[mesh.corners[k].value()] == k) chunker.finalize(mesh.corners[k]);
    if (chunker.chunk_size() >= size) flush();
  }
  chunker.finalize_all();
  flush();
  EXPECT_EQ(glue.graph().node_count(), 0u) << "all is settled";
  return glue.removed_pairs();
}

template <class OptionsOf>
std::uint64_t stream(const Mesh& mesh, std::size_t size, GraphSink& sink, const OptionsOf& options_of) {
  return stream(mesh, size, sink, options_of, [](Glue&) {});
}

}  // namespace reeb::test
