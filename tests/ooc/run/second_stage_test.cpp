// A hierarchy that is made on disk: if memory runs out in the middle, the run ends with an error and the graph is kept.
#include "ooc/run/second_stage.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "ooc/stored_graph/load_graph.h"
#include "tests/support/files.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

// Each triangle is a component of its own.
ComplexMesh separate_triangles(std::uint32_t triangles) {
  std::vector<double> values;
  std::vector<std::vector<std::uint64_t>> simplices;
  for (std::uint32_t v = 0; v < 3 * triangles; v += 3) {
    simplices.push_back({v, v + 1, v + 2});
    for (std::uint32_t corner = v; corner < v + 3; ++corner) values.push_back(corner * 2654435761u >> 8);
  }
  return ComplexMesh(make_complex(std::move(values), std::move(simplices)));
}

// Refuses request n for memory and none else; of those that are counted, from 1.
class RefusedRequest {
 public:
  explicit RefusedRequest(std::uint64_t n) : n_(n) {}

  // The first of the hierarchy on disk.
  bool operator()(const char* owner) {
    if (std::string_view(owner) == "arc records") began_ = true;
    return began_ && ++count_ == n_;
  }
  std::uint64_t count() const { return count_; }

 private:
  const std::uint64_t n_;
  std::atomic<bool> began_ = false;
  std::atomic<std::uint64_t> count_ = 0;
};

TEST(SecondStage, RefusesMoreNodesOrArcsThanItCanNumber) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << 32) - 1;
  EXPECT_NO_THROW(ooc::require_numbers(kMost, kMost, "out.reeb"));
  for (const auto& [nodes, arcs] : {std::pair(kMost + 1, kMost), std::pair(kMost, kMost + 1)}) {
    try {
      ooc::require_numbers(nodes, arcs, "out.reeb");
      ADD_FAILURE() << nodes << " nodes, " << arcs << " arcs";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource);
      EXPECT_NE(error.hint().find("--denoise"), std::string::npos) << error.hint();
    }
  }
}

TEST(SecondStage, KeepsTheGraphIfMemoryRunsOutInTheMiddle) {
  constexpr std::uint32_t kTriangles = 60'000;
  constexpr RunShape kShape{.chunk_triangles = 0, .threads = 1, .form = Form::kIndexed};
  const ComplexMesh mesh = separate_triangles(kTriangles);
  const auto run = [&](std::uint64_t memory, bool graph_only, std::uint64_t& refused) {
    Runner runner(graph_only);
    runner.options().memory_bytes = memory;
    runner.options().buckets = 0;
    RefusedRequest request(refused);
    std::string error;
    {
      const ScopedBudgetFault fault(std::ref(request));
      try {
        runner.run(mesh, kShape);
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::kResource);
        error = e.what();
      }
    }
    refused = request.count();
    EXPECT_EQ(error.empty(), error.find("the graph itself was written") == std::string::npos) << error;
    return read_file(runner.output(3));
  };
  constexpr std::uint64_t kLittle = 20 << 20, kMuch = 1 << 30;
  std::uint64_t requests = 0, none = 0;
  const std::string whole = run(kLittle, false, requests), graph = run(kMuch, true, none);
  ASSERT_GT(requests, 20u) << "the hierarchy was not made on disk";
  ASSERT_NE(whole, graph);
  for (std::uint64_t n = 1; n <= requests && !HasFailure(); ++n) {
    std::uint64_t refused = n;
    const bool kept = run(kLittle, false, refused) == graph;
    EXPECT_TRUE(kept) << "request " << n << " of " << requests;
  }
}

}  // namespace
}  // namespace reeb::test
