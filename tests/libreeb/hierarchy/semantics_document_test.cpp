// The example of docs/SEMANTICS.md: what the page says of it is what comes out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "libreeb/engine/online_reeb.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/hierarchy/levels.h"
#include "tests/support/files.h"

namespace reeb {
namespace {

// Calls take(match) for each match of the pattern.
void for_each_match(const std::string& text, const char* pattern, auto take) {
  const std::regex expression(pattern);
  for (std::sregex_iterator match(text.begin(), text.end(), expression), end; match != end; ++match) take(*match);
}

// The page, with its en dashes as hyphens.
std::string page() {
  return std::regex_replace(test::read_file(REEB_SOURCE_DIR "/docs/SEMANTICS.md"), std::regex("\xE2\x80\x93"), "-");
}

// The part of the page from `begin` up to `end`.
std::string part(const std::string& begin, const std::string& end) {
  const std::string text = page();
  const std::size_t first = text.find(begin);
  EXPECT_NE(first, std::string::npos) << begin;
  return text.substr(first, text.find(end, first + begin.size()) - first);
}

// By name, so ascending: the nodes of the picture.
std::map<std::string, double> documented_values() {
  std::map<std::string, double> values;
  for_each_match(part("### Example", "There are six nodes"), "\n +([0-9.]+)[^A-Z\n]*([A-F]) ",
                 [&](const std::smatch& m) { values[m[2]] = std::stod(m[1]); });
  return values;
}

std::multiset<std::string> arcs_named_in(const std::string& text) {
  std::multiset<std::string> arcs;
  for_each_match(text, "[A-F]-[A-F]", [&](const std::smatch& m) { arcs.insert(m[0]); });
  return arcs;
}

class SemanticsDocument : public testing::Test {
 protected:
  SemanticsDocument() : values_(documented_values()) {
    for (const auto& [name, value] : values_) names_.push_back(name);
    const auto number = [&](char name) {
      return static_cast<std::uint64_t>(std::ranges::find(names_, std::string(1, name)) - names_.begin());
    };
    // A mesh of edges is its own Reeb graph.
    OnlineReeb online;
    std::vector<VertexId> vertices;
    for (const auto& [name, value] : values_) vertices.push_back(online.add_vertex(value));
    for (const std::string& arc : documented_arcs()) {
      const VertexId ends[] = {vertices.at(number(arc[0])), vertices.at(number(arc[2]))};
      online.add_simplex(ends);
    }
    online.finish();
    graph_ = online.snapshot();
    hierarchy_ = build_hierarchy(graph_);
  }

  static std::multiset<std::string> documented_arcs() {
    return arcs_named_in(part("There are six nodes", "; one component"));
  }
  std::string name(const ReebGraph& graph, NodeId node) const {
    return names_.at(graph.nodes.at(node.value()).vertex.value());
  }
  std::multiset<std::string> arcs_of(const ReebGraph& graph) const {
    std::multiset<std::string> arcs;
    for (std::size_t arc = 0; arc < graph.arc_count(); ++arc)
      arcs.insert(name(graph, graph.lo[arc]) + "-" + name(graph, graph.hi[arc]));
    return arcs;
  }

  std::map<std::string, double> values_;
  std::vector<std::string> names_;
  ReebGraph graph_;
  Hierarchy hierarchy_;
};

TEST_F(SemanticsDocument, TheGraphIsThatOfThePicture) {
  ASSERT_EQ(values_.size(), 6u);
  EXPECT_EQ(values_["A"], 0);
  EXPECT_EQ(values_["F"], 4);
  EXPECT_EQ(graph_.node_count(), 6u);
  EXPECT_EQ(arcs_of(graph_), documented_arcs());
  EXPECT_EQ(graph_.arc_count(), 6u);
  EXPECT_EQ(betti_numbers(graph_).components, 1u);
  EXPECT_EQ(betti_numbers(graph_).loops, 1u);
}

TEST_F(SemanticsDocument, ThePairsAreThoseOfThePage) {
  using Row = std::tuple<std::string, std::string, double>;  // type, ends, persistence
  std::multiset<Row> documented, computed;
  for_each_match(part("*In the example:* `Rel1`", "\n## "),
                 "`([A-Za-z0-9]+)` \\(([A-F]), ([A-F])\\) of persistence\\s+([0-9.]*[0-9])",
                 [&](const std::smatch& m) { documented.emplace(m[1], m[2].str() + m[3].str(), std::stod(m[4])); });
  for (const PersistencePair& pair : hierarchy_.pairs) {
    static const std::map<PairType, std::string> kTypes = {
        {PairType::kExt0, "Ext0"}, {PairType::kExt1, "Ext1"}, {PairType::kOrd0, "Ord0"}, {PairType::kRel1, "Rel1"}};
    const std::string lo = name(graph_, pair.lo), hi = name(graph_, pair.hi);
    const double persistence = values_.at(hi) - values_.at(lo);
    computed.emplace(kTypes.at(pair.type), lo + hi, std::round(persistence * 1e9) / 1e9);
  }
  EXPECT_EQ(documented.size(), 3u);
  EXPECT_EQ(computed, documented);
}

TEST_F(SemanticsDocument, TheArcsLiveInTheVersionsOfTheTable) {
  std::multiset<std::string> documented, computed;
  for_each_match(part("| arc | born | died |", "\n\n"), "\n\\| ([^|]*[A-F][^|]*) \\| ([0-9]+) \\| (\\w+) \\|",
                 [&](const std::smatch& m) {
                   for (const std::string& arc : arcs_named_in(m[1]))
                     documented.insert(arc + " " + m[2].str() + " " + m[3].str());
                 });
  for (const ArcVersion& arc : hierarchy_.arcs)
    computed.insert(name(graph_, arc.lo) + "-" + name(graph_, arc.hi) + " " + std::to_string(arc.born) + " " +
                    (arc.died == kNeverDies ? "never" : std::to_string(arc.died)));
  EXPECT_EQ(documented.size(), 8u);
  EXPECT_EQ(computed, documented);
}

TEST_F(SemanticsDocument, TheLevelsAreThoseOfTheTable) {
  const std::vector<LevelSize> sizes = level_sizes(hierarchy_);
  std::size_t rows = 0;
  for_each_match(part("| version | nodes | arcs | least threshold |", "\n\n"),
                 "\n\\| ([0-9]+) \\| ([0-9]+) \\| ([0-9]+) \\| ([^|]*) \\|", [&](const std::smatch& m) {
                   const auto version = static_cast<std::uint32_t>(std::stoul(m[1]));
                   ASSERT_EQ(version, rows++);
                   ASSERT_LT(version, sizes.size());
                   EXPECT_EQ(sizes[version].nodes, std::stoul(m[2]));
                   EXPECT_EQ(sizes[version].arcs, std::stoul(m[3]));
                   static const std::string kAbove = "the next number above ";
                   const std::string least = m[4];
                   const bool is_above = least.starts_with(kAbove);
                   EXPECT_EQ(least == "0", !is_above);
                   EXPECT_NEAR(sizes[version].persistence, is_above ? std::stod(least.substr(kAbove.size())) : 0, 1e-9);
                 });
  EXPECT_EQ(rows, 3u);
  EXPECT_EQ(rows, sizes.size());
  EXPECT_EQ(version_below(hierarchy_, 0.3), 0u) << "1.8 - 1.5 is above 0.3 in binary64";
}

}  // namespace
}  // namespace reeb
