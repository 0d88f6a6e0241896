// Gluing at scale: the live graph keeps its promises after every fragment, and the graph does not
// depend on how a mesh of many thousand triangles is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "io/generator/generator.h"
#include "io/generator/noise.h"
#include "libreeb/engine/chunk_sweep.h"
#include "libreeb/engine/glue.h"
#include "libreeb/engine/stream_chunker.h"

namespace reeb::test {
namespace {

enum class Function { kY, kZ, kRandom };

struct Mesh {
  std::vector<double> values;
  std::vector<VertexId> corners;
  std::vector<std::size_t> last_use;  // of each vertex: a corner
  std::uint64_t max_loops = 0;
};

Mesh make_mesh(io::MeshKind kind, io::MeshOrder order, Function function) {
  io::GeneratorOptions options;
  options.kind = kind;
  options.order = order;
  options.triangles = 30'000;
  const auto reader = io::generate_mesh(options);
  Mesh mesh;
  mesh.max_loops = reader->topology().max_reeb_loops;
  for (MeshBatch batch; reader->read(batch);) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i)
      mesh.values.push_back(function == Function::kRandom
                                ? static_cast<double>(io::mix(mesh.values.size()) >> 11)
                                : batch.coordinates[function == Function::kY ? 1 : 2][i]);
    mesh.corners.insert(mesh.corners.end(), batch.triangles.begin(), batch.triangles.end());
  }
  mesh.last_use.assign(mesh.values.size(), 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) mesh.last_use[mesh.corners[i].value()] = i;
  return mesh;
}

struct KeepingSink : GraphSink {
  void add_nodes(std::span<const SettledNode> more) override {
    for (const SettledNode& node : more) nodes.push_back(node.key);
  }
  void add_arcs(const SettledArcs& more) override {
    arcs.insert(arcs.end(), more.arcs.begin(), more.arcs.end());
  }
  std::vector<SweepKey> nodes;
  std::vector<ArcKeys> arcs;
};

// `overstated`: every third vertex is said to be used earlier, whether it is or not.
ReebGraph graph_in_chunks(const Mesh& mesh, std::size_t size, bool overstated = false) {
  KeepingSink sink;
  StreamChunker chunker(1, false);
  ChunkSweep sweep;
  Glue glue(sink, false);
  Chunk chunk;
  std::vector<std::vector<double>> values;
  Fragment fragment;
  const auto flush = [&] {
    chunker.take(chunk, values);
    for (std::size_t v = 0; overstated && v < chunk.vertex_count(); v += 3) chunk.uses[v] |= kUsedEarlier;
    sweep.run(chunk, values[0], fragment);
    glue.add(fragment);
    glue.graph().validate();
  };
  for (const double value : mesh.values) chunker.add_vertex({&value, 1}, {});
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    chunker.add_simplex({&mesh.corners[i], 3});
    for (std::size_t k = i; k < i + 3; ++k)
      if (mesh.last_use[mesh.corners[k].value()] == k) chunker.finalize(mesh.corners[k]);
    if (chunker.chunk_size() >= size) flush();
  }
  chunker.finalize_all();
  flush();
  EXPECT_EQ(glue.graph().node_count(), 0u) << "all is settled";
  return make_graph(std::move(sink.arcs), std::move(sink.nodes));
}

TEST(GlueStress, TheLiveGraphStaysSoundAndTheCutsDoNotShow) {
  for (const auto kind : {io::MeshKind::kScan, io::MeshKind::kPlate, io::MeshKind::kGrid})
    for (const auto order : {io::MeshOrder::kRows, io::MeshOrder::kPatches})
      for (const auto function : {Function::kY, Function::kZ, Function::kRandom}) {
        SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << ", order "
                                        << static_cast<int>(order) << ", function "
                                        << static_cast<int>(function));
        const Mesh mesh = make_mesh(kind, order, function);
        const ReebGraph whole = graph_in_chunks(mesh, mesh.corners.size());
        EXPECT_EQ(betti_numbers(whole).components, 1u);
        EXPECT_LE(betti_numbers(whole).loops, mesh.max_loops);
        for (const std::size_t size : {300u, 4096u})
          for (const bool overstated : {false, true})
            EXPECT_TRUE(graph_in_chunks(mesh, size, overstated) == whole)
                << "chunks of " << size << (overstated ? ", earlier uses overstated" : "");
      }
}

}  // namespace
}  // namespace reeb::test
