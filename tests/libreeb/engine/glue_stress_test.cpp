// Gluing at scale: the live graph is consistent after every fragment, and the result does not depend on how a mesh of
// many thousand triangles is cut.
#include <gtest/gtest.h>

#include "tests/libreeb/engine/streamed_mesh.h"

namespace reeb::test {
namespace {

ReebGraph graph_in_chunks(const Mesh& mesh, std::size_t size, bool overstated = false) {
  KeepingSink sink;
  stream(
      mesh, size, sink, [](double, double) { return SweepOptions{}; }, [](Glue&) {}, overstated);
  return sink.graph();
}

TEST(GlueStress, TheLiveGraphStaysSoundAndTheCutsDoNotShow) {
  for (const auto kind : {io::MeshKind::kScan, io::MeshKind::kPlate, io::MeshKind::kGrid})
    for (const auto order : {io::MeshOrder::kRows, io::MeshOrder::kPatches})
      for (const auto function : {Function::kY, Function::kZ, Function::kRandom}) {
        SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << ", order " << static_cast<int>(order)
                                        << ", function " << static_cast<int>(function));
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
