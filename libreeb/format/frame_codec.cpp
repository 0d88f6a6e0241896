#include "libreeb/format/frame_codec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "libreeb/base/byte_coding.h"
#include "libreeb/graph/packed_buckets.h"

namespace reeb {
namespace {

// An eight-byte column, gathered from or scattered into structures.
using Column = std::vector<std::uint64_t>;

std::uint64_t bits_of(double value) { return std::bit_cast<std::uint64_t>(value); }
double double_of(std::uint64_t bits) { return std::bit_cast<double>(bits); }

void encode_nodes(std::span<const SettledNode> nodes, bool positions, ByteWriter& out) {
  Column column(nodes.size());
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint64_t bits = ordered_bits(nodes[i].key.value + 0.0);
    column[i] = bits - before;
    before = bits;
  }
  out.planes(column);
  out.deltas(nodes.size(), [&](std::size_t i) { return nodes[i].key.vertex.value(); });
  if (!positions) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < nodes.size(); ++i) column[i] = bits_of(nodes[i].position[axis]);
    out.planes(column);
  }
}

const char* decode_nodes(ByteReader& in, std::size_t count, bool positions, std::vector<SettledNode>& nodes) {
  if (!in.may_hold(count, positions ? 33 : 9)) return "a frame is too short for its nodes";
  Column column(count);
  nodes.resize(count);
  in.planes(column);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bits += column[i];
    nodes[i] = {};
    nodes[i].key.value = from_ordered_bits(bits) + 0.0;
    if (!std::isfinite(nodes[i].key.value)) return "a node's value is not finite";
  }
  std::uint64_t vertex = 0;
  for (SettledNode& node : nodes) {
    vertex = in.delta(vertex);
    node.key.vertex = VertexId(vertex);
  }
  for (std::size_t i = 1; i < count; ++i)
    if (!(nodes[i - 1].key < nodes[i].key)) return "the nodes of a frame are not ascending";
  if (!positions) return nullptr;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    in.planes(column);
    for (std::size_t i = 0; i < count; ++i) nodes[i].position[axis] = double_of(column[i]);
  }
  return nullptr;
}

// `died` is stored as its distance from kNeverDies, which for arcs that never die compresses to almost nothing.
void encode_arcs(std::span<const FileArc> arcs, ByteWriter& out) {
  out.varints(arcs.size(), [&, distance = std::uint32_t{0}](std::size_t i) mutable {
    const std::uint32_t now = kNeverDies - arcs[i].died;
    return now - std::exchange(distance, now);
  });
  out.varints(arcs.size(), [&](std::size_t i) { return arcs[i].born; });
  out.deltas(arcs.size(), [&](std::size_t i) { return arcs[i].lo; });
  out.varints(arcs.size(), [&](std::size_t i) { return delta_code(arcs[i].hi, arcs[i].lo); });
}

const char* decode_arcs(ByteReader& in, std::size_t count, std::vector<FileArc>& arcs) {
  if (!in.may_hold(count, 4)) return "a frame is too short for its arcs";
  arcs.resize(count);
  std::uint64_t distance = 0;
  for (FileArc& arc : arcs) {
    distance += in.varint32();
    if (distance >= kNeverDies) return "an arc dies before it can be born";
    arc.died = kNeverDies - static_cast<std::uint32_t>(distance);
  }
  for (FileArc& arc : arcs) {
    arc.born = in.varint32();
    if (arc.born >= arc.died) return "an arc dies before it is born";
  }
  std::uint64_t lo = 0;
  for (FileArc& arc : arcs) arc.lo = lo = in.delta(lo);
  for (FileArc& arc : arcs) arc.hi = in.delta(arc.lo);
  return nullptr;
}

void encode_versions(std::span<const VersionCounts> versions, bool embedding, ByteWriter& out) {
  Column column;
  for (const VersionCounts& version : versions) column.push_back(bits_of(version.persistence));
  out.planes(column);
  VersionCounts before;
  for (const VersionCounts& version : versions) {
    out.delta(version.nodes, before.nodes);
    out.delta(version.arcs, before.arcs);
    if (embedding) out.delta(version.buckets, before.buckets);
    before = version;
  }
}

const char* decode_versions(ByteReader& in, std::size_t count, bool embedding, std::vector<VersionCounts>& versions) {
  if (!in.may_hold(count, 10)) return "a frame is too short for its versions";
  Column column(count);
  versions.resize(count);
  in.planes(column);
  VersionCounts before{.persistence = HUGE_VAL};
  for (std::size_t i = 0; i < count; ++i) {
    VersionCounts& version = versions[i];
    version.persistence = double_of(column[i]);
    if (!(version.persistence >= 0 && version.persistence <= before.persistence))
      return "the persistences of a frame are not descending";
    version.nodes = in.delta(before.nodes);
    version.arcs = in.delta(before.arcs);
    version.buckets = embedding ? in.delta(before.buckets) : 0;
    before = version;
  }
  return nullptr;
}

std::uint64_t joined(std::uint32_t low, std::uint32_t high) { return low | std::uint64_t{high} << 32; }
std::uint32_t low_half(std::uint64_t bits) { return static_cast<std::uint32_t>(bits); }
std::uint32_t high_half(std::uint64_t bits) { return static_cast<std::uint32_t>(bits >> 32); }

// Whole numbers in the order of the floats.
std::uint32_t ordered_of(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits >> 31) != 0 ? ~bits : bits | std::uint32_t{1} << 31;
}
float float_of(std::uint32_t ordered) {
  return std::bit_cast<float>((ordered >> 31) != 0 ? ordered & ~(std::uint32_t{1} << 31) : ~ordered);
}

// A rim is near the mean: the difference has few digits. Signs are in the lowest bit.
std::uint32_t rim_code(float rim, double mean) {
  const std::uint32_t difference = ordered_of(rim) - ordered_of(static_cast<float>(mean));
  return difference << 1 ^ (0 - (difference >> 31));
}
float rim_from(std::uint32_t code, double mean) {
  return float_of(ordered_of(static_cast<float>(mean)) + (code >> 1 ^ (0 - (code & 1))));
}

// A spread says how wide a contour is, for which 8 binary digits are enough: the file has the upper half of its bits.
std::uint32_t rounded_bits(float spread) {
  constexpr std::uint32_t kLowerHalf = 0xffff, kLargest = 0x7f7f0000;
  const auto bits = std::bit_cast<std::uint32_t>(spread);
  return std::min((bits + kLowerHalf / 2 + 1) & ~kLowerHalf, kLargest);
}

// Of buckets of several vertices: spread and the rim's x, then its y and z.
void encode_spreads(std::span<const Bucket> buckets, ByteWriter& out) {
  Column first, second;
  for (const Bucket& bucket : buckets) {
    if (bucket.count <= 1) continue;
    first.push_back(joined(rounded_bits(bucket.spread), rim_code(bucket.rim[0], bucket.mean[0])));
    second.push_back(joined(rim_code(bucket.rim[1], bucket.mean[1]), rim_code(bucket.rim[2], bucket.mean[2])));
  }
  out.planes(first);
  out.planes(second);
}

const char* decode_spreads(ByteReader& in, std::span<Bucket> buckets) {
  const auto count = std::ranges::count_if(buckets, [](const Bucket& bucket) { return bucket.count > 1; });
  if (!in.may_hold(static_cast<std::uint64_t>(count), 16)) return "a frame is too short for its buckets";
  Column first(static_cast<std::size_t>(count)), second(first.size());
  in.planes(first);
  in.planes(second);
  std::size_t i = 0;
  for (Bucket& bucket : buckets) {
    if (bucket.count <= 1) continue;
    bucket.spread = std::bit_cast<float>(low_half(first[i]));
    const std::array<std::uint32_t, 3> codes = {high_half(first[i]), low_half(second[i]), high_half(second[i])};
    for (std::size_t axis = 0; axis < 3; ++axis) bucket.rim[axis] = rim_from(codes[axis], bucket.mean[axis]);
    ++i;
    if (!(bucket.spread >= 0 && std::isfinite(bucket.spread))) return "a bucket's spread is not one";
    for (const float x : bucket.rim)
      if (!std::isfinite(x)) return "a bucket's rim is not finite";
  }
  return nullptr;
}

void encode_buckets(const GraphFrame& frame, bool has_spreads, ByteWriter& out) {
  const std::vector<Bucket>& buckets = frame.buckets;
  out.varints(frame.bucket_counts.size(), [&](std::size_t i) { return frame.bucket_counts[i]; });
  out.deltas(buckets.size(), [&](std::size_t i) { return static_cast<std::uint64_t>(buckets[i].index); });
  out.varints(buckets.size(), [&](std::size_t i) { return buckets[i].count; });
  Column column(buckets.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < column.size(); ++i) column[i] = bits_of(buckets[i].mean[axis]);
    out.planes(column);
  }
  if (has_spreads) encode_spreads(buckets, out);
}

const char* decode_buckets(ByteReader& in, bool has_spreads, GraphFrame& frame) {
  frame.bucket_counts.resize(frame.arcs.size());
  std::uint64_t total = 0;
  for (std::uint32_t& count : frame.bucket_counts) total += count = in.varint32();
  if (!in.may_hold(total, 26)) return "a frame is too short for its buckets";
  frame.buckets.resize(total);
  std::uint64_t index = 0;
  for (Bucket& bucket : frame.buckets) {
    index = in.delta(index);
    bucket.index = static_cast<std::int64_t>(index);
  }
  for (Bucket& bucket : frame.buckets) bucket.count = in.varint();
  Column column(total);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    in.planes(column);
    for (std::size_t i = 0; i < column.size(); ++i) frame.buckets[i].mean[axis] = double_of(column[i]);
  }
  return has_spreads ? decode_spreads(in, frame.buckets) : nullptr;
}

}  // namespace

void GraphFrame::clear() {
  nodes.clear();
  arcs.clear();
  versions.clear();
  bucket_counts.clear();
  buckets.clear();
}

void GraphFrame::add_buckets(std::span<const std::byte> packed) {
  bucket_counts.push_back(static_cast<std::uint32_t>(packed_count(packed)));
  if (!unpack_buckets(packed, buckets)) throw std::logic_error("GraphFrame: a list of buckets cannot be read");
}

void encode_graph_frame(const GraphFrame& frame, const FileFlags& flags, std::vector<std::byte>& bytes) {
  ByteWriter out(bytes);
  encode_versions(frame.versions, flags.has_embedding, out);
  encode_nodes(frame.nodes, flags.has_positions, out);
  encode_arcs(frame.arcs, out);
  if (flags.has_embedding) encode_buckets(frame, flags.has_spreads, out);
}

const char* decode_graph_frame(std::span<const std::byte> payload, const FrameHeader& header, const FileFlags& flags,
                               GraphFrame& frame) {
  ByteReader in(payload);
  frame.clear();
  if (const char* why = decode_versions(in, header.versions, flags.has_embedding, frame.versions)) return why;
  if (const char* why = decode_nodes(in, header.nodes, flags.has_positions, frame.nodes)) return why;
  if (const char* why = decode_arcs(in, header.records, frame.arcs)) return why;
  if (flags.has_embedding)
    if (const char* why = decode_buckets(in, flags.has_spreads, frame)) return why;
  return in.done() ? nullptr : "a frame's payload does not end where its counts say";
}

void encode_pairs_frame(std::span<const FilePair> pairs, std::vector<std::byte>& bytes) {
  ByteWriter out(bytes);
  for (const FilePair& pair : pairs)
    out.u8(static_cast<std::uint8_t>(static_cast<unsigned>(pair.type) | (pair.kept ? 4u : 0u)));
  out.deltas(pairs.size(), [&](std::size_t i) { return pairs[i].lo; });
  out.varints(pairs.size(), [&](std::size_t i) { return delta_code(pairs[i].hi, pairs[i].lo); });
}

const char* decode_pairs_frame(std::span<const std::byte> payload, const FrameHeader& header,
                               std::vector<FilePair>& pairs) {
  ByteReader in(payload);
  pairs.clear();
  if (!in.may_hold(header.nodes, 3)) return "a frame is too short for its pairs";
  pairs.resize(header.nodes);
  for (FilePair& pair : pairs) {
    const std::uint8_t bits = in.u8();
    if (bits > 7) return "a pair has an unknown type";
    pair.type = static_cast<PairType>(bits & 3);
    pair.kept = (bits & 4) != 0;
    if (pair.kept && pair.type != PairType::kExt1) return "a pair that is not a loop is marked as kept";
  }
  std::uint64_t lo = 0;
  for (FilePair& pair : pairs) pair.lo = lo = in.delta(lo);
  for (FilePair& pair : pairs) pair.hi = in.delta(pair.lo);
  return in.done() ? nullptr : "a frame's payload does not end where its counts say";
}

}  // namespace reeb
