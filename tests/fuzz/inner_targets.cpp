#include "tests/fuzz/inner_targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "io/file/checksum.h"
#include "io/functions/function_source.h"
#include "libreeb/engine/online_reeb.h"
#include "libreeb/noise/denoise.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/chunks/last_use_sidecar.h"
#include "ooc/reeb_file/reeb_file.h"
#include "ooc/run/compute.h"
#include "ooc/stored_graph/segment_store.h"
#include "tests/fuzz/legality.h"
#include "tests/fuzz/memory_file.h"
#include "tests/libreeb/engine/player.h"
#include "tests/model/reference_reeb.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/files.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/random.h"
#include "tests/support/scratch.h"

namespace reeb::test {
namespace {

using io::expect;
using io::violation;

// ---- inputs as choices

// The bytes of an input, one after the other; zeros after the last.
class Choices {
 public:
  explicit Choices(const std::string& bytes) : bytes_(bytes) {}
  bool left() const { return at_ < bytes_.size(); }
  unsigned next() { return left() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }
  unsigned below(unsigned bound) { return next() % bound; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

// Up to 24 vertices with few different values, and up to 60 simplices of up to five corners.
Complex complex_from(Choices& choices) {
  const unsigned vertices = 1 + choices.below(24);
  Complex complex;
  for (unsigned v = 0; v < vertices; ++v) {
    const auto value = static_cast<signed char>(choices.next());
    complex.values.push_back(value == -128 ? -0.0 : 0.25 * value);
    complex.positions.push_back({static_cast<double>(v), 0.5, complex.values.back()});
  }
  while (choices.left() && complex.simplices.size() < 60) {
    const unsigned shape = choices.next();
    std::vector<std::uint64_t> corners(shape % 8 < 5 ? 3 : 1 + shape / 8 % 5);
    for (std::uint64_t& corner : corners) corner = choices.below(vertices);
    complex.simplices.push_back(std::move(corners));
  }
  return complex;
}

void expect_same(const ReebGraph& graph, const ReebGraph& expected, const Complex& complex, const char* when) {
  graph.validate();
  if (without_positions(graph) != without_positions(expected))
    violation(std::string("the graph is exact ") + when + "; got\n" + describe(graph) + "instead of\n" +
              describe(expected) + describe(complex));
}

std::vector<std::string> random_choices() {
  std::vector<std::string> inputs;
  Random random(1);
  for (const std::size_t size : {20u, 60u, 100u, 200u, 300u})
    for (int i = 0; i < 8; ++i) {
      std::string bytes(size, '\0');
      for (char& byte : bytes) byte = static_cast<char>(random.below(i % 2 == 0 ? 256 : 40));
      inputs.push_back(std::move(bytes));
    }
  return inputs;
}

// ---- the engine

bool run_engine(const std::string& bytes) {
  Choices choices(bytes);
  constexpr std::array<std::size_t, 4> kBatches = {1, 2, 6, 4096}, kWaiting = {0, 3, 15, std::size_t{1} << 30};
  OnlineReeb::Options options;
  options.batch_triangles = kBatches[choices.below(4)];
  options.waiting_triangles = kWaiting[choices.below(4)];
  const auto finalization = static_cast<Finalization>(choices.below(4));
  const std::uint64_t seed = choices.next();
  const unsigned snapshots = choices.next();
  const double noise_below = 0.25 * choices.below(64);
  const Complex complex = complex_from(choices);
  const ReebGraph expected = reference_reeb(complex);

  OnlineReeb engine(options);
  Player(complex, finalization, seed).play(engine, [&](std::size_t vertices, std::size_t simplices) {
    if ((simplices + snapshots) % 8 >= snapshots / 32) return;
    expect_same(engine.snapshot(), reference_reeb(beginning(complex, vertices, simplices)), complex, "at any moment");
  });
  expect_same(engine.snapshot(), expected, complex, "at the end");
  engine.finish();
  expect_same(engine.snapshot(), expected, complex, "when finished");

  options.noise_below = noise_below;
  OnlineReeb quiet(options);
  Player(complex, finalization, seed).play(quiet);
  quiet.finish();
  const Denoised rest = denoise(quiet.snapshot(), noise_below), all = denoise(expected, noise_below);
  expect_same(rest.graph, all.graph, complex, "without noise");
  expect(quiet.removed_pairs() + rest.removed.size() == all.removed.size(), "each pair of noise is counted once");
  return true;
}

// ---- whole runs

bool run_pipeline(const std::string& bytes) {
  Choices choices(bytes);
  static const ooc::Scratch outputs, temporary;
  const unsigned form = choices.below(3);
  ooc::ComputeOptions options;
  options.chunk_triangles = choices.below(10);
  options.stretch_triangles = options.chunk_triangles * choices.below(9);
  options.memory_bytes = 16u << 20;
  options.buckets = choices.below(3) == 0 ? 0 : 1 + choices.below(20);
  options.may_reorder = choices.below(2) != 0;
  options.may_guess = choices.below(2) != 0;
  options.graph_only = choices.below(4) != 0;
  options.checkpoint_seconds = 1e9;
  options.temp_dir = temporary.path();
  const std::uint64_t seed = choices.next();
  const Complex complex = complex_from(choices);
  const ComplexMesh mesh(complex);
  ColumnFunction function(3);
  const std::array<VertexFunction*, 1> functions = {&function};
  const std::array<std::string, 1> paths = {outputs.path() + "/graph.reeb"};
  ooc::MeshInput input;
  if (form == 0) {
    input.indexed = std::make_unique<IndexedComplex>(mesh);
  } else if (form == 1) {
    input.read_again = [&] { return std::make_unique<ComplexStream>(mesh, seed); };
    input.reader = input.read_again();
  } else {
    input.reader = std::make_unique<UnfinalizedComplex>(mesh, seed);
  }
  ooc::compute(std::move(input), functions, paths, options);
  {
    const ooc::ReebFile file(paths[0]);
    expect_same(file.load(0).graph, reference_reeb(complex), complex, "after a run");
    file.verify();
  }
  std::filesystem::remove(paths[0]);
  expect(std::filesystem::is_empty(temporary.path()), "a run leaves no temporary files");
  return true;
}

// ---- blocks of sorted runs

constexpr std::size_t kMostRecords = 4096;

std::string block(std::size_t records, std::span<const std::byte> packed) {
  std::string bytes{static_cast<char>(records & 255), static_cast<char>(records >> 8)};
  bytes.append(reinterpret_cast<const char*>(packed.data()), packed.size());
  return bytes;
}

// Calls decode(count, packed) with a copy of exactly the size of the block, for the sanitizers.
template <class Decode>
bool run_block(const std::string& bytes, const Decode& decode) {
  if (bytes.size() < 2) return false;
  Choices head(bytes);
  std::size_t count = head.next();
  count = (count | head.next() << 8) % kMostRecords;
  const auto rest = std::as_bytes(std::span(bytes)).subspan(2);
  const std::vector<std::byte> packed(rest.begin(), rest.end());
  return decode(count, std::span(packed));
}

bool run_node_block(const std::string& bytes) {
  return run_block(bytes, [](std::size_t count, std::span<const std::byte> packed) {
    std::vector<SettledNode> nodes(count), keys(count);
    const bool good = ooc::NodeCodec::decode(packed, nodes), good_keys = ooc::NodeCodec::decode_keys(packed, keys);
    expect(good_keys || !good, "keys are read if whole records are");
    for (std::size_t i = 0; good && i < count; ++i)
      expect(std::bit_cast<std::uint64_t>(nodes[i].key.value) == std::bit_cast<std::uint64_t>(keys[i].key.value) &&
                 nodes[i].key.vertex == keys[i].key.vertex,
             "keys are the same with and without positions");
    return good;
  });
}

bool run_arc_block(const std::string& bytes) {
  return run_block(bytes, [](std::size_t count, std::span<const std::byte> packed) {
    std::vector<ooc::StoredArc> arcs(count), keys(count);
    std::vector<std::byte> pool;
    const bool good = ooc::ArcCodec::decode(packed, arcs, pool);
    expect(ooc::ArcCodec::decode_keys(packed, keys) || !good, "keys are read if whole records are");
    ooc::CoarsenedList coarsened;
    for (std::size_t i = 0; good && i < count; ++i) {
      const auto [first, size] = arcs[i].payload;
      expect(first <= pool.size() && size <= pool.size() - first, "a payload is in the pool");
      const auto payload = std::span(pool).subspan(first, size);
      std::vector<Bucket> buckets;
      for (const int exponent : {-60, 0, 40}) {
        buckets.clear();
        const bool is_payload = ooc::decode_buckets(payload, exponent, buckets);
        expect(ooc::packed_list(payload, exponent, coarsened).has_value() || !is_payload,
               "a payload that can be read can be packed");
      }
    }
    return good;
  });
}

std::vector<std::string> node_blocks() {
  std::vector<std::string> blocks;
  for (const std::size_t count : {1u, 3u, 40u, 200u}) {
    std::vector<SettledNode> nodes;
    for (std::size_t i = 0; i < count; ++i)
      nodes.push_back({{0.5 * static_cast<double>(i / 3), VertexId(i * i % 1000)}, {0.25, -1, static_cast<double>(i)}});
    std::vector<std::byte> packed;
    ooc::NodeCodec::encode(nodes, packed);
    blocks.push_back(block(count, packed));
  }
  return blocks;
}

std::vector<std::string> arc_blocks() {
  std::vector<std::string> blocks;
  for (const std::size_t count : {1u, 3u, 40u, 120u}) {
    std::vector<ooc::StoredArc> arcs;
    std::vector<std::byte> pool;
    for (std::size_t i = 0; i < count; ++i) {
      const double value = 0.5 * static_cast<double>(i / 2);
      const auto first = static_cast<std::uint32_t>(pool.size());
      std::vector<Bucket> buckets;
      for (std::size_t k = 0; k < i % 4; ++k)
        buckets.push_back({static_cast<std::int64_t>(3 * i + k), 1 + 100 * k, {0.1, 0.5, value}});
      std::vector<std::byte> list;
      pack_buckets(buckets, list);
      ooc::encode_list(list, -3, pool);
      arcs.push_back({{{value, VertexId(i)}, {value + 1, VertexId(i + 1000)}},
                      {first, static_cast<std::uint32_t>(pool.size()) - first}});
    }
    std::vector<std::byte> packed;
    ooc::ArcCodec::encode(arcs, pool, packed);
    blocks.push_back(block(count, packed));
  }
  return blocks;
}

// ---- functions

constexpr std::uint64_t kValues = 8;

// Looks the values up in order, and in another one; both must say the same.
bool run_values(const std::string& path) {
  io::FunctionSpec spec{io::FunctionSpec::Kind::kFile, 0, path, "file:values"};
  std::vector<VertexId> ids;
  for (std::uint64_t v = 0; v < kValues; ++v) ids.emplace_back(v);
  const auto read = [&](bool backwards, std::vector<double>& values) {
    try {
      io::FunctionSource source(spec, MeshInfo{});
      if (backwards) std::reverse(ids.begin(), ids.end());
      source.check_count(kValues);
      values.resize(kValues);
      source.evaluate(ids, {}, values);
      for (const double value : values) expect(std::isfinite(value), "values are finite");
      return true;
    } catch (const Error& error) {
      io::expect_helpful(error);
      return false;
    }
  };
  std::vector<double> values, backwards;
  const bool good = read(false, values);
  expect(read(true, backwards) == good, "values are good in any order");
  std::reverse(backwards.begin(), backwards.end());
  expect(!good || values == backwards, "values are the same in any order");
  return good;
}

bool run_value_text(const std::string& bytes) { return run_values(MemoryFile(bytes).path()); }

bool run_raw_values(const std::string& bytes) {
  static const ooc::Scratch scratch;
  const std::string path = scratch.path() + "/values.f64";
  write_file(path, bytes);
  return run_values(path);
}

bool run_function_name(const std::string& bytes) {
  try {
    const io::FunctionSpec spec = io::parse_function(bytes);
    expect(spec.text == bytes, "a function is named as the user wrote it");
    const std::string part = io::file_name_part(spec);
    expect(part.find_first_of(":/") == std::string::npos, "a part of a file name has no folder");
    return true;
  } catch (const Error& error) {
    expect(error.kind() == ErrorKind::kUsage && !error.hint().empty(), "a wrong name is an error of usage with a hint");
    return false;
  }
}

std::vector<std::string> value_texts() {
  return {"0\n1\n2\n3\n4\n5\n6\n7\n", "# eight\n-0.0 \n1e-300\r\n2.5\n\n3\n4\n+5\n6 # last\n-7e3", "0 1 2 3 4 5 6 7\n"};
}
std::vector<std::string> raw_values() {
  std::string bytes;
  for (std::uint64_t v = 0; v < kValues; ++v) {
    const double value = v == 3 ? -0.0 : 0.5 * static_cast<double>(v);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  return {bytes, bytes + bytes, bytes.substr(0, 20)};
}
std::vector<std::string> function_names() {
  return {"x", "z", "c0", "c18446744073709551615", "index", "random:1", "property:red", "file:a/b.f64", "c", "random:"};
}

// ---- what is kept for later runs

const ooc::MeshIdentity kMesh{1, 2, 3};
const ooc::RunIdentity kRun{4, 5, 6};
constexpr std::size_t kGridWidth = 20;

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
  std::uint64_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}
std::uint64_t checksum_of(const std::string& bytes, std::size_t begin, std::size_t end, std::uint64_t seed = 0) {
  return io::checksum(std::as_bytes(std::span(bytes)).subspan(begin, end - begin), seed);
}
void put_number(std::string& bytes, std::size_t at, std::uint64_t number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

bool run_sidecar(const std::string& bytes) {
  static const ooc::Scratch temporary;
  const MemoryFile file(bytes);
  MemoryBudget budget(64 << 20);
  const io::TempDir temp(temporary.path());
  constexpr std::uint64_t kVertices = kGridWidth * kGridWidth;
  ooc::SidecarLoad load = ooc::load_sidecar(file.path(), kMesh, kVertices, temp, budget, 1 << 16);
  expect(load.uses.has_value() == load.note.empty(), "a sidecar that is not used has a note");
  if (!load.uses) return false;
  std::vector<std::uint32_t> entries(kVertices);
  load.uses->read(VertexId(0), entries);
  for (const std::uint32_t entry : entries)
    expect(ooc::UseEntry(entry).unused() || ooc::UseEntry(entry).last_block() < load.uses->summary().block_count,
           "the last block of a vertex exists");
  return true;
}

std::vector<std::string> sidecars() {
  const ooc::Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const ooc::ModelMesh mesh = ooc::grid_mesh(kGridWidth, kGridWidth);
  std::vector<std::string> files;
  for (const std::uint64_t block : {1u, 64u, 4096u}) {
    ooc::ModelIndexedMesh indexed(mesh);
    auto uses = ooc::scan_last_use(indexed, temp, budget, {.block_triangles = block});
    const std::string path = scratch.path() + "/mesh.final";
    ooc::save_sidecar(path, kMesh, *uses);
    files.push_back(read_file(path));
  }
  return files;
}

// Of the header, and of the one block of entries.
void fix_sidecar_checksums(std::string& bytes) {
  constexpr std::size_t kHeader = 104;
  if (bytes.size() < kHeader) return;
  const std::uint64_t samples = number_at(bytes, kHeader - 8);
  if (samples > bytes.size() / 8 || kHeader + 8 * samples + 8 > bytes.size()) return;
  const std::size_t profile_end = kHeader + 8 * static_cast<std::size_t>(samples);
  put_number(bytes, profile_end, checksum_of(bytes, kHeader, profile_end, checksum_of(bytes, 0, kHeader)));
  const std::size_t block = profile_end + 8;
  if (block + 16 > bytes.size()) return;
  const std::uint64_t packed = number_at(bytes, block);
  if (packed > bytes.size() - block - 16) return;
  put_number(bytes, block + 8, checksum_of(bytes, block + 16, block + 16 + static_cast<std::size_t>(packed)));
}

bool run_checkpoint(const std::string& bytes) {
  const MemoryFile file(bytes);
  ooc::CheckpointLoad load;
  try {
    load = ooc::load_checkpoint(file.path(), kRun);
  } catch (const Error& error) {
    if (error.cause() != ErrorCause::kChanged) throw;  // the run adds the name of the mesh
    return false;
  }
  expect(load.checkpoint.has_value() == load.note.empty(), "a checkpoint that is not used has a note");
  if (!load.checkpoint) return false;
  try {
    std::vector<std::uint64_t> array;
    while (load.state->left() != 0) load.state->get_array(array);
  } catch (const DamagedState&) {
    return false;
  }
  return true;
}

std::vector<std::string> checkpoints() {
  const ooc::Scratch scratch;
  const std::string path = scratch.path() + "/checkpoint";
  std::vector<std::string> files;
  for (std::uint64_t ranges = 1; ranges < 4; ++ranges) {
    ooc::Checkpoint checkpoint;
    checkpoint.place = {.triangles = 8192, .next_vertex = 7, .batches = 3, .chunk_blocks = 2, .ranges = {}};
    checkpoint.place.ranges.resize(static_cast<std::size_t>(ranges));
    checkpoint.block_triangles = 4096;
    ooc::write_checkpoint(path, kRun, checkpoint, [&](StateWriter& out) {
      out.put_array(std::vector<std::uint64_t>(static_cast<std::size_t>(5 * ranges), 9));
      out.put_array(std::vector<std::uint64_t>{1, 2, 3});
    });
    files.push_back(read_file(path));
  }
  return files;
}

void fix_checkpoint_checksum(std::string& bytes) {
  if (bytes.size() >= 8) put_number(bytes, bytes.size() - 8, checksum_of(bytes, 0, bytes.size() - 8));
}

constexpr std::string_view kFunctionWords[] = {"x", "c", "index", "random:", "property:", "file:", ":", "/"};

const std::array<FuzzTarget, 9> kTargets = {{
    {"engine", run_engine, random_choices, {}, nullptr},
    {"pipeline", run_pipeline, random_choices, {}, nullptr},
    {"nodes", run_node_block, node_blocks, {}, nullptr},
    {"arcs", run_arc_block, arc_blocks, {}, nullptr},
    {"values", run_value_text, value_texts, {}, nullptr},
    {"raw-values", run_raw_values, raw_values, {}, nullptr},
    {"sidecar", run_sidecar, sidecars, {}, fix_sidecar_checksums},
    {"checkpoint", run_checkpoint, checkpoints, {}, fix_checkpoint_checksum},
    {"function", run_function_name, function_names, kFunctionWords, nullptr},
}};

}  // namespace

std::span<const FuzzTarget> inner_fuzz_targets() { return kTargets; }

}  // namespace reeb::test
