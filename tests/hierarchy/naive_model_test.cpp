// The hierarchy against copy-and-cancel: pairs, kept loops and the graph of every version.
#include <gtest/gtest.h>

#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/levels.h"
#include "tests/model/naive_hierarchy.h"
#include "tests/model/reference_pairs.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/random_graph.h"
#include "tests/support/seed.h"

namespace reeb::test {
namespace {

void expect_same(const ReebGraph& graph) {
  const NaiveHierarchy naive = naive_hierarchy(graph, reference_pairs(graph));
  const Hierarchy hierarchy = build_hierarchy(graph);
  ASSERT_EQ(hierarchy.pairs, naive.pairs);
  ASSERT_EQ(hierarchy.persistence.size() + 1, naive.versions.size());
  for (std::uint32_t version = 0; version < naive.versions.size(); ++version)
    ASSERT_EQ(without_positions(graph_at(hierarchy, graph, version)),
              without_positions(naive.versions[version]))
        << "version " << version << " of\n" << describe(graph);
}

TEST(HierarchyAgainstNaive, EveryVersionOfSmallGraphs) {
  const std::uint64_t base = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000) && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    expect_same(random_graph(base + i));
  }
}

TEST(HierarchyAgainstNaive, EveryVersionOfGraphsWithManyLoops) {
  const std::uint64_t base = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000) / 20 && !HasFatalFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "seed " << base + i);
    expect_same(random_graph(base + i, 60));
  }
}

}  // namespace
}  // namespace reeb::test
