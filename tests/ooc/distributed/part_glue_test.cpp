// Shares of random complexes, computed apart and glued in any grouping, against the reference.
#include "libreeb/parts/part_glue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/distributed/compute_part.h"
#include "ooc/distributed/open_part_state.h"
#include "ooc/distributed/part_run.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/random.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"
#include "tests/support/whole_run.h"  // scratch folders in memory

namespace reeb::test {
namespace {

// What settles anywhere.
class Collected : public GraphSink {
 public:
  void add_nodes(std::span<const SettledNode> added) override {
    for (const SettledNode& node : added) nodes.push_back(node.key);
  }
  void add_arcs(const SettledArcs& settled) override {
    arcs.insert(arcs.end(), settled.arcs.begin(), settled.arcs.end());
  }

  std::vector<SweepKey> nodes;
  std::vector<ArcKeys> arcs;
};

struct Group {
  OpenPart open;
  std::vector<PartSpan> runs;
};

Group run_share(const Complex& complex, std::uint32_t part, std::uint32_t parts, Random& random, Collected& settled) {
  const ComplexMesh data(complex);
  ColumnFunction function(3);
  VertexFunction* const functions[] = {&function};
  const ooc::Scratch scratch;
  const std::string output = scratch.path() + "/out";
  ooc::ComputeOptions options;
  options.buckets = static_cast<std::uint32_t>(random.below(2) * 4);
  options.chunk_triangles = 1 + random.below(20);
  ooc::MeshInput input;
  input.path = "-";
  input.indexed = std::make_unique<IndexedComplex>(data);
  ooc::RunContext run(input, functions, std::span(&output, 1), options);
  ooc::WholeMesh mesh = ooc::open_whole_mesh(run, input, parts);
  ooc::PartUses uses = ooc::find_part_uses(run, input, mesh);
  ooc::PartResult done = ooc::run_part(run, input, mesh, uses, part, options);
  std::vector<SettledNode> nodes;
  for (run.stores[0]->rewind_nodes(); run.stores[0]->read_nodes(nodes, 100);) settled.add_nodes(nodes);
  ooc::ArcPiece piece;
  for (run.stores[0]->rewind_arcs(); run.stores[0]->read_arcs(piece, 100);) settled.add_arcs({.arcs = piece.arcs});
  return {std::move(done.parts[0].open), {{part, part}}};
}

// Glues groups; what remains goes through its bytes, as between processes.
Group glue(std::vector<Group>& groups, std::uint32_t parts, Collected& settled) {
  PartGlue glue(settled, parts, {});
  Group all;
  for (Group& group : groups) {
    glue.add(group.open, group.runs);
    glue.glue().graph().validate();
    all.runs.insert(all.runs.end(), group.runs.begin(), group.runs.end());
  }
  OpenPart open;
  glue.copy_open(open);
  EXPECT_GE(glue.copy_bytes(), open.live.memory_bytes() + open.spans.capacity() * sizeof(PartSpan));
  open.live.bucket_begin.clear();
  StateBytes bytes;
  ooc::write_open_part(bytes, open);
  ooc::read_open_part(bytes, parts, all.open);
  return all;
}

std::vector<ArcKeys> arcs_of(const ReebGraph& graph) {
  std::vector<ArcKeys> arcs;
  for (std::size_t a = 0; a < graph.arc_count(); ++a)
    arcs.push_back({graph.nodes[graph.lo[a].value()], graph.nodes[graph.hi[a].value()]});
  return arcs;
}

TEST(PartGlue, GivesTheGraphOfAnyComplexInAnyGrouping) {
  const std::uint64_t seed = base_seed();
  for (std::uint64_t i = 0; i < case_count(2000); ++i) {
    Random random(seed + i);
    const Complex complex = random_complex(seed + i);
    const auto parts = static_cast<std::uint32_t>(1 + random.below(6));
    Collected settled;
    std::vector<Group> groups;
    for (std::uint32_t part = 0; part < parts; ++part)
      groups.push_back(run_share(complex, part, parts, random, settled));
    for (std::size_t left = groups.size(); left > 1; --left) std::swap(groups[left - 1], groups[random.below(left)]);
    while (groups.size() > 1) {
      const auto count = static_cast<std::ptrdiff_t>(2 + random.below(groups.size() - 1));
      std::vector<Group> some(std::make_move_iterator(groups.begin()), std::make_move_iterator(groups.begin() + count));
      groups.erase(groups.begin(), groups.begin() + count);
      groups.push_back(glue(some, parts, settled));
    }
    const Group all = glue(groups, parts, settled);
    ASSERT_TRUE(all.open.live.nodes.empty()) << "complex " << seed + i;
    const ReebGraph expected = reference_reeb(complex);
    std::sort(settled.nodes.begin(), settled.nodes.end());
    std::sort(settled.arcs.begin(), settled.arcs.end());
    ASSERT_EQ(settled.nodes, expected.nodes) << "complex " << seed + i << " in " << parts << " parts";
    ASSERT_TRUE(settled.arcs == arcs_of(expected)) << "complex " << seed + i << " in " << parts << " parts";
  }
}

// Whenever the change is noticed, as the n-th look at the mesh or at the function.
TEST(PartRun, OfAnInputThatChangesLeavesNoFile) {
  class Values : public ColumnFunction {
   public:
    explicit Values(const std::function<void()>& check) : ColumnFunction(3), check_(check) {}
    void check_unchanged() const override { check_(); }

   private:
    const std::function<void()>& check_;
  };
  const ComplexMesh data(random_complex(3));
  for (const bool scans : {false, true}) {
    bool was_noticed = true;
    for (int n = 1; was_noticed; ++n) {
      ASSERT_LT(n, 100);
      SCOPED_TRACE(testing::Message() << (scans ? "scan" : "fragment") << ", look " << n);
      int looks = 0;
      const std::function<void()> check = [&] {
        if (++looks >= n) throw input_changed();
      };
      Values function(check);
      VertexFunction* const functions[] = {&function};
      const ooc::Scratch scratch;
      const std::string output = scratch.path() + "/out";
      ooc::MeshInput input;
      input.path = "-";
      input.indexed = std::make_unique<IndexedComplex>(data);
      input.check_unchanged = check;
      was_noticed = false;
      try {
        if (scans)
          ooc::scan_part(std::move(input), functions, output, {}, {0, 2, {}});
        else
          ooc::compute_part(std::move(input), functions, std::span(&output, 1), {}, {0, 2, {}});
      } catch (const Error& error) {
        was_noticed = error.cause() == ErrorCause::kChanged;
        ASSERT_TRUE(was_noticed) << error.what();
      }
      EXPECT_EQ(std::filesystem::exists(output), !was_noticed);
      EXPECT_GT(looks, 0);
    }
  }
}

TEST(PartSet, KnowsGapsWhateverTheOrder) {
  PartSet set(6);
  EXPECT_EQ(set.first_missing(), 0u);
  set.add({2, 2});
  set.add({4, 5});
  set.add({0, 0});
  EXPECT_EQ(set.first_missing(), 1u);
  EXPECT_FALSE(set.contains(PartSpan{2, 4}));
  EXPECT_TRUE(set.contains(PartSpan{4, 5}));
  EXPECT_EQ(set.runs(), (std::vector<PartSpan>{{0, 0}, {2, 2}, {4, 5}}));
  set.add({1, 3});
  EXPECT_EQ(set.first_missing(), 6u);
  EXPECT_TRUE(set.contains(PartSpan{0, 5}));
  EXPECT_EQ(set.runs(), (std::vector<PartSpan>{{0, 5}}));
}

TEST(OpenPart, RefusesWhatIsNoPath) {
  OpenPart part;
  part.live.nodes = {{{0, VertexId(0)}, kUsedLater}, {{1, VertexId(1)}, kUsedLater}, {{2, VertexId(2)}, kUsedLater}};
  part.live.positions.resize(3);
  part.spans.assign(3, {0, 1});
  part.live.arcs = {{FragmentNode(0), FragmentNode(1)}, {FragmentNode(1), FragmentNode(2)}};
  part.live.edges = {{FragmentNode(0), FragmentNode(2)}};
  part.live.path_begin = {0, 2};
  part.live.path_arcs = {FragmentArc(1), FragmentArc(0)};
  EXPECT_NO_THROW(check_open_part(part, 2));
  EXPECT_THROW(check_open_part(part, 1), DamagedState);  // a vertex that no part names
  OpenPart odd = part;
  odd.live.path_arcs = {FragmentArc(0), FragmentArc(1)};
  EXPECT_THROW(check_open_part(odd, 2), DamagedState);
  odd = part;
  odd.live.arcs[0].lo = FragmentNode(7);
  EXPECT_THROW(check_open_part(odd, 2), DamagedState);
  odd = part;
  odd.live.nodes[1].key.vertex = VertexId(0);
  EXPECT_THROW(check_open_part(odd, 2), DamagedState);
}

TEST(OpenPart, CoarsensBucketsWithoutLosingVertices) {
  Fragment fragment;
  fragment.options.bucket_exponent = 0;
  fragment.bucket_begin = {0, 3, 4};
  for (const std::int64_t index : {-3, -2, 1, 1}) fragment.buckets.push_back({index, 2, {}});
  coarsen_buckets(fragment, 2);
  EXPECT_EQ(fragment.bucket_begin, (std::vector<std::uint32_t>{0, 2, 3}));
  ASSERT_EQ(fragment.buckets.size(), 3u);
  EXPECT_EQ(fragment.buckets[0].index, -1);
  EXPECT_EQ(fragment.buckets[0].count, 4u);
  EXPECT_EQ(fragment.buckets[1].index, 0);
}

}  // namespace
}  // namespace reeb::test
