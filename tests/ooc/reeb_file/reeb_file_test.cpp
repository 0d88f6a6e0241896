// The .reeb container: each level is read as it was written, and damage never yields a wrong level.
#include "ooc/reeb_file/reeb_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "libreeb/format/reeb_format.h"
#include "libreeb/graph/packed_buckets.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "tests/ooc/reeb_file/made_up_hierarchy.h"
#include "tests/support/files.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;
using test::read_file;

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

// A new file each time: some file systems flush a file that is overwritten.
void write_bytes(const std::string& path, const std::string& bytes) {
  fs::remove(path);
  std::ofstream(path, std::ios::binary) << bytes;
}

const FileMeta kMeta{.function = "laplacian:1",
                     .function_min = -0.25,
                     .function_max = 0.75,
                     .mesh_vertices = 1234,
                     .mesh_triangles = 2468,
                     .denoise_threshold = 0.125,
                     .denoised_pairs = 7,
                     .bucket_exponent = MadeUp::kBucketExponent};

FileMeta meta_of(const MadeUp& made) {
  FileMeta meta = kMeta;
  meta.mesh_vertices = made.vertices();
  return meta;
}

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
    write_hierarchy_file(path, meta_of(made), made.graph, made.hierarchy,
                         seed % 2 == 0 ? ArcBucketsView{} : made.buckets.view());
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
  write_hierarchy_file(path, meta_of(made), made.graph, made.hierarchy, made.buckets.view());
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
  write_hierarchy_file(path, meta_of(made), made.graph, made.hierarchy, made.buckets.view());
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
  std::size_t next = 0;
  file.for_each_pair([&](const PairKeys& pair) {
    ASSERT_LT(next, rows.size());
    EXPECT_EQ(pair.lo, rows[next].lo.key);
    EXPECT_EQ(pair.hi, rows[next].hi.key);
    EXPECT_EQ(pair.type, rows[next].type);
    EXPECT_EQ(pair.kept, rows[next].kept);
    ++next;
  });
  EXPECT_EQ(next, rows.size());
}

TEST(GraphFile, PiecesDoNotShowAndBucketsFollowTheirArcs) {
  const TemporaryFolder folder;
  const io::TempDir temp(folder.path().string());
  const MadeUp made = MadeUpMaker(3).make(9'000, 15'000, 0);
  const FileMeta meta = meta_of(made);
  write_graph_file(folder / "whole.reeb", meta, made.graph, made.buckets.view());
  const std::string expected = read_file(folder / "whole.reeb");
  using Ends = GraphFileWriter::ArcEnds;
  struct Case {
    std::size_t piece;
    Ends ends;
    bool background;
  };
  for (const auto& [piece, ends, background] :
       {Case{1, Ends::kKeys, false}, Case{7, Ends::kKeys, true}, Case{100'000, Ends::kKeysInMemory, true}}) {
    GraphFileWriter writer(folder / "pieces.reeb", meta,
                           {.nodes = made.graph.node_count(),
                            .has_embedding = true,
                            .ends = ends,
                            .background = background,
                            .temp = &temp});
    for (std::size_t i = 0; i < made.graph.node_count(); ++i) {
      const SettledNode node{made.graph.nodes[i], made.graph.positions[i]};
      writer.add_nodes({&node, 1});
    }
    for (std::size_t first = 0; first < made.graph.arc_count(); first += piece) {
      const std::size_t last = std::min(first + piece, made.graph.arc_count());
      std::vector<ArcKeys> arcs;
      for (std::size_t i = first; i < last; ++i)
        arcs.push_back({made.graph.nodes[made.graph.lo[i].value()], made.graph.nodes[made.graph.hi[i].value()]});
      ArcLists lists;
      for (std::size_t i = first; i < last; ++i) lists.add(made.buckets.view().of(i));
      writer.add_arcs(std::span<const ArcKeys>(arcs), lists.view());
    }
    writer.finish();
    EXPECT_EQ(read_file(folder / "pieces.reeb"), expected) << "pieces of " << piece;
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

// No arc silently loses its buckets.
TEST(GraphFile, AListThatCannotBeReadIsRefused) {
  const TemporaryFolder folder;
  GraphFileWriter writer(folder / "a.reeb", {}, {.nodes = 2, .has_embedding = true});
  writer.add_nodes(std::array{SettledNode{{0, VertexId(0)}, {}}, SettledNode{{1, VertexId(1)}, {}}});
  std::vector<std::byte> list;
  pack_buckets(std::array{Bucket{0, 1, {1, 2, 3}}}, list);
  list.pop_back();
  const std::array ends{std::uint64_t{list.size()}};
  EXPECT_THROW(writer.add_arcs(std::array{FileArc{0, 1, 0, kNeverDies}}, {ends, list}), std::logic_error);
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
  write_hierarchy_file(folder / "a.reeb", meta_of(made), made.graph, made.hierarchy);
  MadeUp shuffled = made;
  std::shuffle(shuffled.hierarchy.arcs.begin(), shuffled.hierarchy.arcs.end(), std::mt19937_64(1));
  fs::create_directory(folder / "other");
  write_hierarchy_file(folder / "other/b.reeb", meta_of(made), shuffled.graph, shuffled.hierarchy);
  EXPECT_EQ(read_file(folder / "a.reeb"), read_file(folder / "other/b.reeb"));
}

// Expects the buckets of a level to be those of the live records, if it has any.
void expect_buckets_of(const MadeUp& made, std::uint32_t version, const Level& level) {
  if (level.buckets.offsets.empty()) return;
  std::vector<Bucket> expected;
  for (std::size_t i = 0; i < made.hierarchy.arcs.size(); ++i)
    if (made.hierarchy.arcs[i].born <= version && version < made.hierarchy.arcs[i].died)
      for (const Bucket& bucket : made.buckets.view().of(i)) expected.push_back(bucket);
  std::vector<Bucket> given = level.buckets.buckets;
  const auto key = [](const Bucket& b) { return std::tuple(b.index, b.count, b.mean); };
  for (auto* list : {&expected, &given})
    std::ranges::sort(*list, [&](const Bucket& a, const Bucket& b) { return key(a) < key(b); });
  EXPECT_EQ(given, expected);
}

// Reads every level that `bytes` yields. Each of them must be right. Returns their number, or -1 if the file was
// refused.
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
        expect_buckets_of(made, version, level);
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
  MadeUp made = MadeUpMaker(21).make(7, 12, 2);
  std::vector<ReebGraph> expected;
  TemporaryFolder folder;
  std::string bytes;

  explicit SmallFile(bool embedding) {
    write_hierarchy_file(folder / "a.reeb", meta_of(made), made.graph, made.hierarchy,
                         embedding ? made.buckets.view() : ArcBucketsView{});
    bytes = read_file(folder / "a.reeb");
    for (std::uint32_t v = 0; v <= made.hierarchy.persistence.size(); ++v) expected.push_back(naive_level(made, v));
  }
};

class DamagedFile : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Embedding, DamagedFile, testing::Bool());

TEST_P(DamagedFile, EveryPrefixOfASmallOneIsRefusedOrRight) {
  const SmallFile small(GetParam());
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

TEST_P(DamagedFile, EveryFlippedBitOfASmallOneIsNoticed) {
  const SmallFile small(GetParam());
  for (std::size_t bit = 0; bit < small.bytes.size() * 8; ++bit) {
    SCOPED_TRACE(testing::Message() << "byte " << bit / 8 << " bit " << bit % 8);
    std::string bytes = small.bytes;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << (bit % 8)));
    levels_given(small.folder / "bad.reeb", bytes, small.made, small.expected);
    if (testing::Test::HasFailure()) break;
  }
}

// A file of many frames, and three of its levels.
struct LargeFile {
  MadeUp made = MadeUpMaker(6).make(20'000, 40'000, 8'000);
  TemporaryFolder folder;
  std::string bytes;
  std::vector<Level> levels;  // the coarsest, one between, the full graph

  explicit LargeFile(bool embedding) {
    write_hierarchy_file(folder / "a.reeb", meta_of(made), made.graph, made.hierarchy,
                         embedding ? made.buckets.view() : ArcBucketsView{});
    bytes = read_file(folder / "a.reeb");
    const ReebFile file(folder / "a.reeb");
    for (const LevelLine& line : {file.levels().front(), file.levels()[file.levels().size() / 2], file.levels().back()})
      levels.push_back(file.load(line.version));
  }

  // Returns how many of the levels `damaged` yields. Each of them must be right.
  std::size_t given_by(const std::string& damaged) const {
    write_bytes(folder / "bad.reeb", damaged);
    std::size_t given = 0;
    try {
      const ReebFile file(folder / "bad.reeb");
      EXPECT_THROW(file.verify(), Error);
      for (const Level& expected : levels) {
        const Level level = file.load(expected.version);
        EXPECT_EQ(level.graph, expected.graph);
        expect_same_buckets(level.buckets, expected.buckets);
        ++given;
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_FALSE(error.hint().empty());
    }
    return given;
  }
};

TEST_P(DamagedFile, SomePrefixesAndFlippedBitsOfALargeOne) {
  const LargeFile large(GetParam());
  std::mt19937_64 random(4);
  std::array<int, 4> cut{}, flipped{};
  for (int i = 0; i < 100; ++i) {
    const std::size_t place = random() % large.bytes.size();
    SCOPED_TRACE(testing::Message() << "byte " << place);
    ++cut[large.given_by(large.bytes.substr(0, place))];
    std::string bytes = large.bytes;
    bytes[place] = static_cast<char>(bytes[place] ^ (1 << (random() % 8)));
    ++flipped[large.given_by(bytes)];
  }
  // Many positions are after the coarsest level and before the end of the finest.
  EXPECT_GT(cut[1] + cut[2], 10);
  EXPECT_GT(flipped[1] + flipped[2], 10);
}

TEST(ReebFile, AnEmbeddingThatLosesOrMakesVerticesIsNoticed) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(11).make(50, 90, 15);
  const auto verify = [&](const FileMeta& meta, const ArcBuckets& buckets) {
    write_hierarchy_file(folder / "a.reeb", meta, made.graph, made.hierarchy, buckets.view());
    ReebFile(folder / "a.reeb").verify();
  };
  ASSERT_NO_THROW(verify(meta_of(made), made.buckets));
  FileMeta meta = meta_of(made);
  ++meta.mesh_vertices;
  EXPECT_THROW(verify(meta, made.buckets), Error) << "one is missing";
  meta.mesh_vertices -= 2;
  EXPECT_THROW(verify(meta, made.buckets), Error) << "one is too many";

  ArcBuckets wrong = made.buckets;
  wrong.buckets[0].index += 100;
  EXPECT_THROW(verify(meta_of(made), wrong), Error) << "beyond its arc";
  wrong = made.buckets;
  std::swap(wrong.buckets[0], wrong.buckets[1]);
  EXPECT_THROW(verify(meta_of(made), wrong), Error) << "not ascending";
  wrong = made.buckets;
  wrong.buckets.back().count += 1'000'000;
  EXPECT_THROW(verify(meta_of(made), wrong), Error) << "a later version has more than the mesh";
}

// Headers with the right checksum (FORMAT.md), each with one number that is not that of the content.
TEST(ReebFile, EachNumberOfTheHeaderIsVerified) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(6).make(20'000, 40'000, 8'000);
  const std::string path = folder / "a.reeb";
  write_hierarchy_file(path, meta_of(made), made.graph, made.hierarchy, made.buckets.view());
  const std::string bytes = read_file(path);
  FileHeader header;
  {
    const ReebFile file(path);
    ASSERT_NO_THROW(file.verify());
    header = file.header();
  }
  const auto last = header.levels.size() - 1;
  ASSERT_GE(header.levels[last].frames, 3u);
  using Lie = std::function<void(FileHeader&)>;
  const std::vector<std::pair<const char*, Lie>> lies = {
      {"nothing", [](FileHeader&) {}},
      {"nodes", [](FileHeader& h) { ++h.nodes; }},
      {"arcs", [](FileHeader& h) { --h.arcs; }},
      {"components", [](FileHeader& h) { ++h.components; }},
      {"loops", [](FileHeader& h) { ++h.loops; }},
      {"records", [](FileHeader& h) { ++h.records; }},
      {"kept loops", [](FileHeader& h) { ++h.kept_loops; }},
      {"vertices", [](FileHeader& h) { ++h.mesh_vertices; }},
      {"digest", [](FileHeader& h) { h.content_digest ^= 1; }},
      {"nodes of a level", [&](FileHeader& h) { --h.levels[last - 1].nodes; }},
      {"arcs of a level", [&](FileHeader& h) { --h.levels[last - 1].arcs; }},
      {"buckets of a level", [&](FileHeader& h) { --h.levels[last - 1].buckets; }},
      {"memory of a level", [&](FileHeader& h) { h.levels[last - 1].memory_bytes -= 8; }},
      {"bytes of a level", [&](FileHeader& h) { --h.levels[last - 1].file_bytes; }},
      {"threshold of a level",
       [&](FileHeader& h) { h.levels[last - 1].threshold = std::nextafter(h.levels[last - 1].threshold, 1e300); }},
      {"fewer frames",
       [&](FileHeader& h) {
         h.levels[last].frames = h.levels[last - 1].frames;
         h.levels[last].file_bytes = h.levels[last - 1].file_bytes;
       }},
      {"frames that are not needed",
       [&](FileHeader& h) {
         h.levels[last - 1].frames = h.levels[last].frames;
         h.levels[last - 1].file_bytes = h.levels[last].file_bytes;
       }},
  };
  for (const auto& [name, lie] : lies) {
    FileHeader forged = header;
    lie(forged);
    std::vector<std::byte> region;
    encode_header(forged, region);
    const std::uint64_t checksum = io::checksum(region);
    ASSERT_EQ(region.size() + sizeof checksum, header.region_bytes());
    std::string begin(reinterpret_cast<const char*>(region.data()), region.size());
    for (int shift = 0; shift < 64; shift += 8) begin += static_cast<char>(checksum >> shift);
    write_bytes(folder / "forged.reeb", begin + bytes.substr(begin.size()));
    const auto verify = [&] { ReebFile(folder / "forged.reeb").verify(); };
    if (forged == header)
      EXPECT_NO_THROW(verify()) << name;
    else
      EXPECT_THROW(verify(), Error) << name;
  }
}

TEST(ReebFile, ACutFileYieldsTheLevelsOfItsWholeFrames) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(6).make(20'000, 40'000, 8'000);
  write_hierarchy_file(folder / "a.reeb", meta_of(made), made.graph, made.hierarchy);
  const std::string bytes = read_file(folder / "a.reeb");
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

// A frame holds whole arcs, so one of very many buckets makes a large frame. 2^20 to 2^21 buckets can be asked for.
TEST(ReebFile, AnArcOfVeryManyBucketsIsReadAsItWasWritten) {
  constexpr std::int64_t kBuckets = 700'000;
  const TemporaryFolder folder;
  ReebGraph graph;
  graph.nodes = {{0.0, VertexId(0)}, {static_cast<double>(kBuckets), VertexId(1)}};
  graph.lo = {NodeId(0)};
  graph.hi = {NodeId(1)};
  ArcBuckets buckets{.offsets = {0, kBuckets}, .buckets = {}};
  for (std::int64_t i = 0; i < kBuckets; ++i)
    buckets.buckets.push_back({.index = i, .count = 2, .mean = {0.1 * static_cast<double>(i), 1, 2}, .spread = 0.5F});
  FileMeta meta = kMeta;
  meta.function_min = 0;
  meta.function_max = static_cast<double>(kBuckets);
  meta.mesh_vertices = 2 * kBuckets + 2;
  meta.bucket_exponent = 0;
  write_graph_file(folder / "a.reeb", meta, graph, buckets.view());
  const ReebFile file(folder / "a.reeb");
  ASSERT_NO_THROW(file.verify());
  expect_same_buckets(file.load(0).buckets, buckets);
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

TEST(ReebFile, TheFirstThousandNodesOfALargeFileNeedOnlyItsBeginning) {
  const TemporaryFolder folder;
  const MadeUp made = MadeUpMaker(9).make(200'000, 600'000, 1'000'000);
  write_hierarchy_file(folder / "a.reeb", meta_of(made), made.graph, made.hierarchy);
  const ReebFile file(folder / "a.reeb");
  const std::uint64_t limit = std::max<std::uint64_t>(1000, file.levels().front().nodes);
  const std::uint32_t version = file.finest_with_nodes(limit);
  const auto levels = file.levels();
  const auto line = std::ranges::find_if(levels, [&](const LevelLine& level) { return level.version <= version; });
  ASSERT_NE(line, levels.end());
  EXPECT_LT(line->file_bytes, file.file_bytes() / 20);
  write_bytes(folder / "begin.reeb", read_file(folder / "a.reeb").substr(0, line->file_bytes));
  const Level level = ReebFile(folder / "begin.reeb").load(version);
  EXPECT_LE(level.graph.node_count(), limit);
  EXPECT_EQ(level.graph, naive_level(made, version));
}

}  // namespace
}  // namespace reeb::ooc
