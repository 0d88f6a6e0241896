// The records of all levels, and the largest pairs, against the definition.
#include "ooc/reeb_file/level_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "libreeb/base/error.h"
#include "ooc/reeb_file/largest_pairs.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/ooc/reeb_file/made_up_hierarchy.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

std::string write(const Scratch& folder, const MadeUp& made, bool embedded) {
  const std::string path = folder.path() + "/a.reeb";
  const FileMeta meta{.function = "z",
                      .function_min = -0.25,
                      .function_max = 0.75,
                      .mesh_vertices = made.vertices(),
                      .mesh_triangles = 1,
                      .bucket_exponent = MadeUp::kBucketExponent};
  write_hierarchy_file(path, meta, made.graph, made.hierarchy, embedded ? made.buckets.view() : ArcBucketsView{});
  return path;
}

// What a slider makes of the records.
ReebGraph level_of(const LevelHistory& history, const std::vector<FileArc>& records, std::uint32_t version) {
  std::vector<ArcKeys> arcs;
  for (const FileArc& arc : records)
    if (arc.born <= version && version < arc.died)
      arcs.push_back({history.nodes[arc.lo].key, history.nodes[arc.hi].key});
  std::vector<SweepKey> isolated;
  for (const std::uint32_t node : history.isolated) isolated.push_back(history.nodes[node].key);
  ReebGraph graph = make_graph(arcs, isolated);
  std::map<VertexId, Point> places;
  for (const SettledNode& node : history.nodes) places[node.key.vertex] = node.position;
  for (const SweepKey& key : graph.nodes) graph.positions.push_back(places.at(key.vertex));
  return graph;
}

TEST(LevelHistory, HasEveryVersionFromTheFinestOn) {
  const Scratch folder;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto size = static_cast<std::uint32_t>(seed % 40);
    const MadeUp made = MadeUpMaker(seed).make(size, size * 2, size);
    const std::string path = write(folder, made, seed % 2 == 1);
    const auto steps = static_cast<std::uint32_t>(made.hierarchy.persistence.size());
    for (const std::uint32_t finest : {0u, steps / 2, steps}) {
      std::vector<FileArc> records;
      const LevelHistory history = read_history(
          path, finest, [&](const FileArc& arc, const SettledNode& lo, const SettledNode& hi, std::span<const Bucket>) {
            EXPECT_LT(lo.key, hi.key);
            records.push_back(arc);
          });
      ASSERT_EQ(history.versions.size(), steps + 1 - finest);
      for (std::uint32_t version = finest; version <= steps; ++version) {
        const ReebGraph expected = naive_level(made, version);
        ASSERT_EQ(level_of(history, records, version), expected) << "version " << version;
        EXPECT_EQ(history.versions[version - finest].nodes, expected.node_count());
        EXPECT_EQ(history.versions[version - finest].arcs, expected.arc_count());
        EXPECT_EQ(history.versions[version - finest].persistence,
                  version == 0 ? 0 : made.hierarchy.persistence[version - 1]);
      }
    }
  }
}

TEST(LevelHistory, RefusesAVersionThatTheFileDoesNotHave) {
  const Scratch folder;
  const MadeUp made = MadeUpMaker(5).make(20, 40, 20);
  const std::string path = write(folder, made, true);
  const auto steps = static_cast<std::uint32_t>(made.hierarchy.persistence.size());
  const auto visit = [](const FileArc&, const SettledNode&, const SettledNode&, std::span<const Bucket>) {};
  for (const std::uint32_t finest : {steps + 1, steps + 2, ~0u}) {
    try {
      read_history(path, finest, visit);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(error.file(), path);
      EXPECT_EQ(error.message(), "there is no version " + std::to_string(finest));
    }
  }
}

// Of a file of many frames, only those that the version needs are read.
TEST(LevelHistory, ReadsManyFrames) {
  const Scratch folder;
  const MadeUp made = MadeUpMaker(5).make(20'000, 120'000, 200'000);
  const std::string path = write(folder, made, true);
  const std::uint32_t finest = ReebFile(path).finest_with_nodes(5'000);
  std::vector<FileArc> records;
  std::uint64_t buckets = 0;
  const LevelHistory history = read_history(
      path, finest, [&](const FileArc& arc, const SettledNode&, const SettledNode&, std::span<const Bucket> own) {
        records.push_back(arc);
        if (arc.born <= finest) buckets += own.size();
      });
  ASSERT_EQ(level_of(history, records, finest), naive_level(made, finest));
  EXPECT_EQ(buckets, history.versions.front().buckets);
  EXPECT_LT(history.nodes.size(), made.graph.node_count() / 2);
}

double persistence(const PairRow& row) { return row.hi.key.value - row.lo.key.value; }
auto key_of(const PairRow& row) {
  return std::tuple(-persistence(row), row.type, row.lo.key.vertex, row.hi.key.vertex);
}

TEST(LargestPairs, AreTheFirstOfAllPairs) {
  const Scratch folder;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto size = static_cast<std::uint32_t>(seed % 40);
    const MadeUp made = MadeUpMaker(seed).make(size, size * 2, size);
    const std::string path = write(folder, made, false);
    std::vector<PairRow> all = ReebFile(path).pairs();
    std::ranges::sort(all, {}, key_of);
    for (const std::size_t most : {std::size_t{0}, all.size() / 3, all.size(), all.size() + 5}) {
      const LargestPairs largest = read_largest_pairs(path, most);
      ASSERT_EQ(largest.rows.size(), std::min(most, all.size()));
      EXPECT_TRUE(std::ranges::is_sorted(largest.rows, {}, key_of));
      std::multiset<decltype(key_of(all[0]))> rest;
      for (const PairRow& row : all) rest.insert(key_of(row));
      for (std::size_t i = 0; i < largest.rows.size(); ++i) {
        EXPECT_EQ(persistence(largest.rows[i]), persistence(all[i]));  // which of equal ones is not promised
        const auto found = rest.find(key_of(largest.rows[i]));
        ASSERT_NE(found, rest.end());
        rest.erase(found);
      }
      std::vector<double> loops;
      std::array<std::uint64_t, 4> counts{};
      for (const PairRow& row : all) {
        ++counts[static_cast<std::size_t>(row.type)];
        if (row.type == PairType::kExt1) loops.push_back(persistence(row));
      }
      EXPECT_EQ(largest.loops, loops);
      EXPECT_EQ(largest.counts, counts);
    }
  }
}

TEST(LargestPairs, AreRefusedWithoutAHierarchy) {
  const Scratch folder;
  const std::string path = folder.path() + "/a.reeb";
  write_graph_file(path, {.function = "z"}, ReebGraph{});
  EXPECT_THROW(read_largest_pairs(path, 10), Error);
}

}  // namespace
}  // namespace reeb::ooc
