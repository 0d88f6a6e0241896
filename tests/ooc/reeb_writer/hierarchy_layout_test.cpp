// The layout of a file names the first record, pair, step or isolated node that is impossible.
#include "ooc/reeb_writer/hierarchy_layout.h"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::ooc {
namespace {

// A graph of five nodes: 0 - 1, 2 - 3 and the isolated node 4, and of one step, which removes the arc 2 - 3.
struct Content {
  ReebGraph graph;
  Hierarchy hierarchy;
};

Content sound_content() {
  Content content;
  for (std::uint32_t i = 0; i < 5; ++i) content.graph.nodes.push_back({double(i), VertexId(i)});
  Hierarchy& hierarchy = content.hierarchy;
  hierarchy.arcs = {{NodeId(0), NodeId(1), 0, kNeverDies}, {NodeId(2), NodeId(3), 0, 1}};
  hierarchy.pairs = {{NodeId(2), NodeId(3), PairType::kOrd0, false}, {NodeId(0), NodeId(1), PairType::kExt0, false}};
  hierarchy.persistence = {1};
  hierarchy.isolated = {NodeId(4)};
  return content;
}

// Delivers records in the order in which they are given.
class GivenRecords : public RecordSource {
 public:
  explicit GivenRecords(const std::vector<ArcVersion>& arcs) : arcs_(arcs) {}
  void rewind(Buckets /*buckets*/) override { next_ = 0; }
  bool next(PackedRecord& record) override {
    if (next_ == arcs_.size()) return false;
    record = {arcs_[next_++]};
    return true;
  }

 private:
  const std::vector<ArcVersion>& arcs_;
  std::size_t next_ = 0;
};

HierarchyLayout laid_out(const Content& content, bool background) {
  HierarchyInMemory source(content.graph, content.hierarchy);
  GivenRecords records(content.hierarchy.arcs);
  return lay_out(source, records, background);
}

TEST(HierarchyLayout, CountsNodesAndArcsOfEachVersion) {
  for (const bool background : {false, true}) {
    const HierarchyLayout layout = laid_out(sound_content(), background);
    EXPECT_EQ(layout.records, 2u);
    ASSERT_EQ(layout.versions.size(), 2u);
    EXPECT_EQ(layout.versions[0], (VersionCounts{0, 5, 2, 0}));
    EXPECT_EQ(layout.versions[1], (VersionCounts{1, 3, 1, 0}));
    ASSERT_EQ(layout.cuts.size(), 1u);
    EXPECT_EQ(layout.cuts[0].isolated_end, 1u);
    EXPECT_EQ(layout.cuts[0].record_end, 2u);
    EXPECT_EQ(layout.cuts[0].finest, 0u);
  }
}

TEST(HierarchyLayout, NamesWhatIsImpossible) {
  struct Case {
    std::string expected;
    std::function<void(Content&)> change;
  };
  const auto arc = [](std::size_t i, const ArcVersion& version) {
    return [i, version](Content& content) { content.hierarchy.arcs[i] = version; };
  };
  const Case cases[] = {
      {"arc 0 does not go up to a node", arc(0, {NodeId(1), NodeId(0), 0, kNeverDies})},
      {"arc 0 does not go up to a node", arc(0, {NodeId(0), NodeId(0), 0, kNeverDies})},
      {"arc 1 does not go up to a node", arc(1, {NodeId(2), NodeId(5), 0, 1})},
      {"arc 1 does not live between two versions", arc(1, {NodeId(2), NodeId(3), 1, 1})},
      {"arc 1 does not live between two versions", arc(1, {NodeId(2), NodeId(3), 0, 2})},
      {"arc 0 does not live between two versions", arc(0, {NodeId(0), NodeId(1), 2, kNeverDies})},
      {"arc 1 lives longer than the one before",
       [](Content& content) { std::swap(content.hierarchy.arcs[0], content.hierarchy.arcs[1]); }},
      {"node 3 is neither isolated nor named by an arc", arc(1, {NodeId(1), NodeId(2), 0, 1})},
      {"isolated node 0 is not above the one before it",
       [](Content& content) { content.hierarchy.isolated = {NodeId(5)}; }},
      {"isolated node 1 is not above the one before it",
       [](Content& content) {
         content.hierarchy.isolated = {NodeId(4), NodeId(4)};
       }},
      {"pair 0 does not go up to a node", [](Content& content) { content.hierarchy.pairs[0].hi = NodeId(1); }},
      {"pair 1 does not go up to a node", [](Content& content) { content.hierarchy.pairs[1].hi = NodeId(5); }},
      {"step 1 has a smaller persistence than the one before",
       [](Content& content) { content.hierarchy.persistence = {-1}; }},
      {"step 2 has a smaller persistence than the one before",
       [](Content& content) {
         content.hierarchy.persistence = {1, 0.5};
       }},
  };
  for (const auto& [expected, change] : cases)
    for (const bool background : {false, true}) {
      SCOPED_TRACE(expected);
      Content content = sound_content();
      change(content);
      try {
        laid_out(content, background);
        ADD_FAILURE() << "nothing was thrown";
      } catch (const std::logic_error& error) {
        EXPECT_EQ(error.what(), "Hierarchy: " + expected);
      }
    }
}

}  // namespace
}  // namespace reeb::ooc
