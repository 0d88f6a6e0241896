#include "ooc/distributed/fragment_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/input_file.h"
#include "libreeb/base/error.h"
#include "libreeb/graph/packed_buckets.h"
#include "ooc/distributed/open_part_state.h"
#include "ooc/states/state_file.h"

namespace reeb::ooc {
namespace {

constexpr std::array<char, 8> kFragmentMagic = {'R', 'E', 'E', 'B', 'F', 'R', 'G', '\n'};
constexpr std::uint64_t kFragmentVersion = 2;
constexpr std::size_t kRecordsPerBlock = 4096;
constexpr std::uint64_t kNodes = 1, kArcs = 2;  // kinds of blocks

struct FragmentHeader {
  std::array<char, 8> magic;
  std::uint64_t version;
  std::uint64_t state_bytes;
  std::uint64_t state_checksum;
  std::uint64_t checksum;  // of the header before
};
static_assert(sizeof(FragmentHeader) == 40);

struct BlockHeader {
  std::uint64_t kind, count, bytes;
  std::uint64_t checksum;  // of the header before, then of the bytes
};
static_assert(sizeof(BlockHeader) == 32);

void add_block(io::BufferedWriter& out, std::uint64_t kind, std::size_t count, std::span<const std::byte> packed) {
  BlockHeader header{kind, count, packed.size(), 0};
  header.checksum = io::checksum(packed, io::header_checksum(header));
  out.append(io::object_bytes(header));
  out.append(packed);
}

void add_settled(io::BufferedWriter& out, const PartInfo& info, SegmentStore& store) {
  std::vector<std::byte> packed;
  store.rewind_nodes();
  for (std::vector<SettledNode> nodes; store.read_nodes(nodes, kRecordsPerBlock);) {
    packed.clear();
    NodeCodec::encode(nodes, packed);
    add_block(out, kNodes, nodes.size(), packed);
  }
  store.rewind_arcs();
  std::vector<StoredArc> arcs;
  for (ArcPiece piece; store.read_arcs(piece, kRecordsPerBlock, info.sweep().bucket_exponent);) {
    const ArcListsView lists = piece.lists.view();
    arcs.clear();
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < piece.arcs.size(); ++i) {
      const auto size = static_cast<std::uint32_t>(lists.of(i).size());
      arcs.push_back({piece.arcs[i], {first, size}});
      first += size;
    }
    packed.clear();
    ArcCodec::encode(arcs, lists.bytes, packed);
    add_block(out, kArcs, arcs.size(), packed);
  }
}

// Whether they ascend and are within the values of the arc's ends. REQUIRES: as bucket_index().
template <class AnyBucket>
bool are_along(const SweepKey& lo, const SweepKey& hi, std::span<const AnyBucket> buckets, int exponent) {
  if (buckets.empty()) return true;
  if (buckets.front().index < bucket_index(lo.value, exponent)) return false;
  if (buckets.back().index > bucket_index(hi.value, exponent)) return false;
  const auto falls = [](const AnyBucket& a, const AnyBucket& b) { return a.index >= b.index; };
  return std::ranges::adjacent_find(buckets, falls) == buckets.end();
}

// Checks what readers of .reeb files rely on.
bool are_buckets_of(const ArcKeys& arc, std::span<const Bucket> buckets, int exponent) {
  if (!are_along(arc.lo, arc.hi, buckets, exponent)) return false;
  const auto is_finite = [](auto x) { return std::isfinite(x); };
  return std::ranges::all_of(buckets, [&](const Bucket& bucket) {
    return bucket.count != 0 && bucket.spread >= 0 && is_finite(bucket.spread) &&
           std::ranges::all_of(bucket.mean, is_finite) && std::ranges::all_of(bucket.rim, is_finite);
  });
}

io::File open_input(const std::string& path) {
  io::check_input_file(path);
  return io::File::open_for_reading(path);
}

}  // namespace

void write_fragment(const std::string& path, const OutputOptions& output, const PartInfo& info, const OpenPart& open,
                    SegmentStore& store) {
  io::AtomicFile file(path, {.existing = output.existing, .overwrites = true, .temp_folder = output.temp_folder});
  FragmentHeader header{kFragmentMagic, kFragmentVersion, 0, 0, 0};
  file.out().append(io::object_bytes(header));
  StateFileWriter state(file.out());
  write_info(state, info);
  write_open_part(state, open);
  header.state_bytes = state.bytes();
  header.state_checksum = state.checksum();
  header.checksum = io::header_checksum(header);
  add_settled(file.out(), info, store);
  file.out().overwrite(0, io::object_bytes(header));
  file.commit();
}

bool is_fragment(const std::string& path) { return begins_with(path, kFragmentMagic); }

void FragmentFile::fail(const std::string& why, std::uint64_t offset) const {
  throw Error(ErrorKind::kBadInput, "this fragment " + why, "make its part again with `reeb fragment`")
      .at(file_.path(), std::to_string(offset));
}

FragmentFile::FragmentFile(const std::string& path) : file_(open_input(path)) {
  FragmentHeader header{};
  if (file_.size() < sizeof(header)) {
    if (!is_fragment(path))
      throw Error(ErrorKind::kBadInput, "this is not a fragment", "fragments are made with `reeb fragment`").at(path);
    fail("was cut off", file_.size());
  }
  file_.read_at(0, std::as_writable_bytes(std::span(&header, 1)));
  if (header.magic != kFragmentMagic)
    throw Error(ErrorKind::kBadInput, "this is not a fragment", "fragments are made with `reeb fragment`").at(path);
  if (header.version != kFragmentVersion)
    throw Error(ErrorKind::kBadInput, "this fragment is of another version of this program",
                "make its part again with `reeb fragment`")
        .at(path);
  if (header.checksum != io::header_checksum(header)) fail("is damaged", 0);
  state_begin_ = sizeof(header);
  state_bytes_ = header.state_bytes;
  if (state_bytes_ > file_.size() - state_begin_) fail("was cut off", file_.size());
  if (io::checksum_of(file_, state_begin_, state_bytes_) != header.state_checksum) fail("is damaged", state_begin_);
  at_ = state_begin_ + state_bytes_;
  try {
    StateFileReader in(file_, state_begin_, at_);
    info_ = read_info(in);
    info_bytes_ = state_bytes_ - in.left();
  } catch (const DamagedState&) {
    fail("is damaged", state_begin_);
  }
}

OpenPart FragmentFile::read_open() {
  OpenPart open;
  try {
    StateFileReader in(file_, state_begin_ + info_bytes_, state_begin_ + state_bytes_);
    read_open_part(in, info_.mesh.shares.parts, open);
    if (in.left() != 0 || open.live.options.bucket_exponent != info_.sweep().bucket_exponent) throw DamagedState();
    for (const Fragment::Node& node : open.live.nodes) check_keys(node.key);
    for (std::size_t a = 0; a + 1 < open.live.bucket_begin.size(); ++a) {
      const auto& [lo, hi] = open.live.arcs[a];
      const auto buckets =
          std::span<const BucketSum>(open.live.buckets)
              .subspan(open.live.bucket_begin[a], open.live.bucket_begin[a + 1] - open.live.bucket_begin[a]);
      if (!are_along(open.live.nodes[lo.value()].key, open.live.nodes[hi.value()].key, buckets,
                     open.live.options.bucket_exponent.value()))
        throw DamagedState();
    }
  } catch (const DamagedState&) {
    fail("is damaged", state_begin_ + info_bytes_);
  }
  open.live.removed_pairs = static_cast<std::size_t>(info_.removed_pairs);
  return open;
}

void FragmentFile::check_keys(const SweepKey& key) const {
  if (!(info_.range.min <= key.value && key.value <= info_.range.max)) throw DamagedState();
  if (key.vertex.value() >= info_.mesh.numbers) throw DamagedState();
}

void FragmentFile::read_block(std::uint64_t kind, Block& block) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;
  BlockHeader header{};
  if (file_.size() - at_ < sizeof(header)) fail("was cut off", file_.size());
  file_.read_at(at_, std::as_writable_bytes(std::span(&header, 1)));
  if (header.kind != kind || header.count == 0 || header.count > kRecordsPerBlock || header.bytes > kMostBytes)
    fail("is damaged", at_);
  if (header.bytes > file_.size() - at_ - sizeof(header)) fail("was cut off", file_.size());
  // Packed, and then the payloads of arcs once more.
  block.memory.resize(std::max(block.memory.bytes(), 2 * header.bytes));
  block.packed.clear();  // so that it does not grow beyond that
  block.packed.resize(static_cast<std::size_t>(header.bytes));
  file_.read_at(at_ + sizeof(header), block.packed);
  if (io::checksum(block.packed, io::header_checksum(header)) != header.checksum) fail("is damaged", at_);
  at_ += sizeof(header) + header.bytes;
  block.count = header.count;
}

void FragmentFile::copy_nodes(SegmentStore& store) {
  Block block{.packed = {}, .count = 0, .memory = store.budget().reserve("fragment", 0)};
  std::vector<SettledNode> nodes;
  for (std::uint64_t left = info_.settled_nodes; left != 0; left -= block.count) {
    const std::uint64_t begin = at_;
    read_block(kNodes, block);
    nodes.resize(static_cast<std::size_t>(block.count));
    if (block.count > left || !NodeCodec::decode(block.packed, nodes)) fail("is damaged", begin);
    for (const SettledNode& node : nodes) check_keys(node.key);
    store.add_nodes(nodes);
  }
}

void FragmentFile::copy_arcs(SegmentStore& store, bool with_buckets) {
  Block block{.packed = {}, .count = 0, .memory = store.budget().reserve("fragment", 0)};
  Reservation list_memory = store.budget().reserve("fragment", 0);
  std::vector<Bucket> buckets;
  RecordBatch<StoredArc> batch;
  std::vector<ArcKeys> arcs;
  std::vector<std::uint64_t> list_ends;  // decode() puts the lists into the pool one after the other
  const bool embeds = with_buckets && info_.sweep().bucket_exponent;
  const int exponent = info_.sweep().bucket_exponent.value_or(0);
  for (std::uint64_t left = info_.settled_arcs; left != 0; left -= block.count) {
    const std::uint64_t begin = at_;
    read_block(kArcs, block);
    batch.records.resize(static_cast<std::size_t>(block.count));
    if (block.count > left || !ArcCodec::decode(block.packed, batch.records, batch.pool)) fail("is damaged", begin);
    arcs.clear();
    list_ends.clear();
    for (const StoredArc& arc : batch.records) {
      check_keys(arc.keys.lo);
      check_keys(arc.keys.hi);
      buckets.clear();
      if (const std::size_t most = arc.payload.size / kLeastPackedBucketBytes; most > buckets.capacity()) {
        list_memory.resize(most * sizeof(Bucket));
        buckets.reserve(most);
      }
      if (!(arc.keys.lo < arc.keys.hi) || !unpack_buckets(batch.payload(arc), buckets)) fail("is damaged", begin);
      if (embeds && !are_buckets_of(arc.keys, buckets, exponent)) fail("is damaged", begin);
      arcs.push_back(arc.keys);
      if (embeds) list_ends.push_back(arc.payload.first + std::uint64_t{arc.payload.size});
    }
    store.add_arcs({arcs, {list_ends, batch.pool}, exponent});
  }
}

void FragmentFile::copy_settled(SegmentStore& store, bool with_buckets) {
  try {
    copy_nodes(store);
    copy_arcs(store, with_buckets);
  } catch (const DamagedState&) {
    fail("is damaged", at_);
  }
  if (at_ != file_.size()) fail("is damaged: it is too long", at_);
}

}  // namespace reeb::ooc
