// The .reeb container: what goes in comes out, at every level, and nothing wrong ever does.
#include "ooc/reeb_file.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "libreeb/base/error.h"
#include "ooc/reeb_file_writer.h"
#include "tests/format/made_up_hierarchy.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "reeb-file-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string read_bytes(const std::string& path) {
  std::string bytes(fs::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

const FileMeta kMeta{.function = "laplacian:1", .function_min = -0.25, .function_max = 0.75, .mesh_vertices = 1234,
                     .mesh_triangles = 2468, .denoise_threshold = 0.125, .denoised_pairs = 7, .bucket_exponent = -3};

void expect_same_buckets(const ArcBuckets& a, const ArcBuckets& b) {
  ASSERT_EQ(a.offsets, b.offsets);
  for (std::size_t i = 0; i < a.buckets.size(); ++i) {
    ASSERT_EQ(a.buckets[i].index, b.buckets[i].index);
    ASSERT_EQ(a.buckets[i].count, b.buckets[i].count);
    ASSERT_EQ(a.buckets[i].mean, b.buckets[i].mean);
  }
}

TEST(ReebFile, EveryVersionOfRandomHierarchiesIsTheDefinition) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto size = static_cast<std::uint32_t>(seed % 40);
    const MadeUp made = MadeUpMaker(seed).make(size, size * 2, size);
    const std::string path = folder / "a.reeb";
    write_hierarchy_file(path, kMeta, made.graph, made.hierarchy, seed % 2 == 0 ? ArcBucketsView{} : made.buckets.view());
    const ReebFile file(path);
    ASSERT_EQ(file.damage(), nullptr);
    ASSERT_NO_THROW(file.verify());
    for (std::uint32_t version = 0; version <= made.hierarchy.persistence.size(); ++version)
      ASSERT_EQ(file.load(version).graph, naive_level(made, version)) << "version " << version;
  }
}

TEST(ReebFile, ManyFramesGiveTheSameLevelsAndChoices) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(5).make(20'000, 120'000, 200'000);
  const std::string path = folder / "a.reeb";
  write_hierarchy_file(path, kMeta, made.graph, made.hierarchy, made.buckets.view());
  const ReebFile file(path);
  ASSERT_GT(file.header().graph_frames, 20u);
  ASSERT_NO_THROW(file.verify());
  const auto& persistence = made.hierarchy.persistence;
  for (const LevelLine& line : file.levels()) {
    if (line.version % 3 != 0 && line.version > 1000) continue;
    const ReebGraph expected = naive_level(made, line.version);
    const Level level = file.load(line.version);
    ASSERT_EQ(level.graph, expected);
    EXPECT_EQ(line.nodes, expected.node_count());
    EXPECT_EQ(line.arcs, expected.arc_count());
    EXPECT_EQ(line.threshold, level.threshold);
    EXPECT_EQ(file.version_at(line.threshold), line.version);
    const Level fitting = file.load(file.finest_with_memory(line.memory_bytes));
    EXPECT_LE(level_memory(fitting.graph.node_count(), fitting.graph.arc_count(), fitting.buckets.buckets.size()),
              line.memory_bytes);
  }
  for (const double t : {0.0, 0.001, 0.01, 1.2345, 20.0, 1e9}) {
    const auto cancelled = std::lower_bound(persistence.begin(), persistence.end(), t) - persistence.begin();
    EXPECT_EQ(file.version_at(t), static_cast<std::uint32_t>(cancelled)) << t;
  }
  for (const std::uint64_t limit : {file.levels().front().nodes, std::uint64_t{2'000}, std::uint64_t{19'000}}) {
    const std::uint32_t version = file.finest_with_nodes(limit);
    EXPECT_LE(naive_level(made, version).node_count(), limit);
    EXPECT_GT(naive_level(made, version - 1).node_count(), limit);
  }
  EXPECT_EQ(file.finest_with_nodes(1'000'000), 0u);
  EXPECT_THROW(file.finest_with_nodes(1), Error);
}

TEST(ReebFile, PairsHeaderAndBucketsComeBack) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(11).make(50, 90, 15);
  const std::string path = folder / "a.reeb";
  write_hierarchy_file(path, kMeta, made.graph, made.hierarchy, made.buckets.view());
  const ReebFile file(path);
  const FileHeader& header = file.header();
  EXPECT_EQ(header.function, "laplacian:1");
  EXPECT_EQ(header.function_min, -0.25);
  EXPECT_EQ(header.mesh_triangles, 2468u);
  EXPECT_EQ(header.denoised_pairs, 7u);
  EXPECT_EQ(header.bucket_exponent, -3);
  const auto rows = file.pairs();
  ASSERT_EQ(rows.size(), made.hierarchy.pairs.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PersistencePair& pair = made.hierarchy.pairs[i];
    EXPECT_EQ(rows[i].lo.key, made.graph.nodes[pair.lo.value()]);
    EXPECT_EQ(rows[i].hi.key, made.graph.nodes[pair.hi.value()]);
    EXPECT_EQ(rows[i].hi.position, made.graph.positions[pair.hi.value()]);
    EXPECT_EQ(rows[i].type, pair.type);
    EXPECT_EQ(rows[i].kept, pair.kept);
  }
}

TEST(GraphFile, PiecesDoNotShowAndBucketsFollowTheirArcs) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(3).make(9'000, 15'000, 0);
  FileMeta meta = kMeta;
  for (const SweepKey& node : made.graph.nodes) meta.mesh_vertices = std::max(meta.mesh_vertices, node.vertex.value() + 1);
  write_graph_file(folder / "whole.reeb", meta, made.graph, made.buckets.view());
  const std::string expected = read_bytes(folder / "whole.reeb");
  using Ends = GraphFileWriter::ArcEnds;
  struct Case {
    std::size_t piece;
    Ends ends;
    bool background;
  };
  for (const auto& [piece, ends, background] :
       {Case{1, Ends::kKeys, false}, Case{7, Ends::kKeys, true}, Case{100'000, Ends::kKeysInMemory, true}}) {
    GraphFileWriter writer(folder / "pieces.reeb", meta,
                           {.has_embedding = true, .ends = ends, .background = background});
    for (std::size_t i = 0; i < made.graph.node_count(); ++i) {
      const SettledNode node{made.graph.nodes[i], made.graph.positions[i]};
      writer.add_nodes({&node, 1});
    }
    for (std::size_t first = 0; first < made.graph.arc_count(); first += piece) {
      const std::size_t last = std::min(first + piece, made.graph.arc_count());
      std::vector<ArcKeys> arcs;
      for (std::size_t i = first; i < last; ++i)
        arcs.push_back({made.graph.nodes[made.graph.lo[i].value()], made.graph.nodes[made.graph.hi[i].value()]});
      ArcBucketsView view = made.buckets.view();
      view.offsets = view.offsets.subspan(first, last - first + 1);
      writer.add_arcs(std::span<const ArcKeys>(arcs), view);
    }
    writer.finish();
    EXPECT_EQ(read_bytes(folder / "pieces.reeb"), expected) << "pieces of " << piece;
  }
  const ReebFile file(folder / "pieces.reeb");
  ASSERT_NO_THROW(file.verify());
  const Level level = file.load();
  EXPECT_EQ(level.graph, made.graph);
  expect_same_buckets(level.buckets, made.buckets);
  EXPECT_THROW(file.pairs(), Error);
  EXPECT_THROW(file.version_at(0.1), Error);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2) << "scratch files are left";
}

TEST(GraphFile, EmptyGraph) {
  const TemporaryFolder folder;
  write_graph_file(folder / "a.reeb", {}, {});
  const ReebFile file(folder / "a.reeb");
  ASSERT_NO_THROW(file.verify());
  EXPECT_EQ(file.load().graph.node_count(), 0u);
}

TEST(ReebFile, BytesDependOnTheContentOnly) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(8).make(500, 800, 200);
  write_hierarchy_file(folder / "a.reeb", kMeta, made.graph, made.hierarchy);
  MadeUp shuffled = made;
  std::shuffle(shuffled.hierarchy.arcs.begin(), shuffled.hierarchy.arcs.end(), std::mt19937_64(1));
  fs::create_directory(folder / "other");
  write_hierarchy_file(folder / "other/b.reeb", kMeta, shuffled.graph, shuffled.hierarchy);
  EXPECT_EQ(read_bytes(folder / "a.reeb"), read_bytes(folder / "other/b.reeb"));
}

// Reads all that `bytes` gives; every level that is given is the right one.
// Returns how many levels were given, or -1 if the file was refused.
int levels_given(const std::string& path, const std::string& bytes, const MadeUp& made,
                 const std::vector<ReebGraph>& expected) {
  write_bytes(path, bytes);
  try {
    const ReebFile file(path);
    int given = 0;
    for (std::uint32_t version = 0; version < expected.size(); ++version) {
      try {
        const Level level = file.load(version);
        EXPECT_EQ(level.graph, expected[version]);
        ++given;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
        EXPECT_FALSE(error.position().empty());
      }
    }
    try {
      EXPECT_EQ(file.pairs().size(), made.hierarchy.pairs.size());
    } catch (const Error&) {
    }
    EXPECT_THROW(file.verify(), Error);
    return given;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_FALSE(error.hint().empty());
    return -1;
  }
}

struct SmallFile {
  MadeUp made = MadeUpMaker(21).make(9, 18, 4);
  std::vector<ReebGraph> expected;
  TemporaryFolder folder;
  std::string bytes;

  SmallFile() {
    write_hierarchy_file(folder / "a.reeb", kMeta, made.graph, made.hierarchy);
    bytes = read_bytes(folder / "a.reeb");
    for (std::uint32_t v = 0; v <= made.hierarchy.persistence.size(); ++v) expected.push_back(naive_level(made, v));
  }
};

TEST(ReebFile, EveryPrefixOfASmallFileIsRefusedOrRight) {
  const SmallFile small;
  int refused = 0, whole = 0;
  for (std::size_t size = 0; size < small.bytes.size(); ++size) {
    SCOPED_TRACE(testing::Message() << size << " bytes");
    const int given = levels_given(small.folder / "cut.reeb", small.bytes.substr(0, size), small.made, small.expected);
    refused += given == -1 ? 1 : 0;
    whole += given == static_cast<int>(small.expected.size()) ? 1 : 0;
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(whole, 0) << "a file that lacks only its tail still has its graph";
}

TEST(ReebFile, EveryFlippedBitOfASmallFileIsNoticed) {
  const SmallFile small;
  for (std::size_t bit = 0; bit < small.bytes.size() * 8; ++bit) {
    SCOPED_TRACE(testing::Message() << "byte " << bit / 8 << " bit " << bit % 8);
    std::string bytes = small.bytes;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    levels_given(small.folder / "bad.reeb", bytes, small.made, small.expected);
    if (testing::Test::HasFailure()) break;
  }
}

TEST(ReebFile, ACutFileYieldsTheLevelsOfItsWholeFrames) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(6).make(20'000, 40'000, 8'000);
  write_hierarchy_file(folder / "a.reeb", kMeta, made.graph, made.hierarchy);
  const std::string bytes = read_bytes(folder / "a.reeb");
  const ReebFile whole(folder / "a.reeb");
  for (const LevelLine& line : whole.levels()) {
    write_bytes(folder / "cut.reeb", bytes.substr(0, line.file_bytes + 5));
    const ReebFile cut(folder / "cut.reeb");
    ASSERT_NE(cut.damage(), nullptr);
    EXPECT_EQ(cut.load(line.version).graph, naive_level(made, line.version));
    for (const LevelLine& other : whole.levels()) {
      if (other.frames > line.frames) {
        EXPECT_THROW(cut.load(other.version), Error);
      }
    }
  }
}

TEST(ReebFile, AnUnwritablePlaceIsAResourceErrorAndNothingIsLeft) {
  try {
    write_graph_file("/nowhere/at/all.reeb", {}, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
  }
  const TemporaryFolder folder;
  EXPECT_THROW(write_graph_file(folder.path().string(), {}, {}), Error) << "a folder is no place for a file";
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(ReebFile, TheFirstThousandNodesOfALargeFileLoadFast) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(9).make(200'000, 600'000, 1'000'000);
  write_hierarchy_file(folder / "a.reeb", kMeta, made.graph, made.hierarchy);
  const auto start = std::chrono::steady_clock::now();
  const ReebFile file(folder / "a.reeb");
  const std::uint64_t limit = std::max<std::uint64_t>(1000, file.levels().front().nodes);
  const Level level = file.load(file.finest_with_nodes(limit));
  const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LE(level.graph.node_count(), limit);
  std::printf("%zu nodes of %.1f MB in %.2f ms\n", level.graph.node_count(), static_cast<double>(file.file_bytes()) * 1e-6, ms);
}

}  // namespace
}  // namespace reeb::ooc
