// The payloads of frames: columns of nodes, arc records, versions, buckets and pairs, delta-coded
// (docs/FORMAT.md, Graph frame and Pairs frame). The file layer adds compression and checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "libreeb/format/file_header.h"
#include "libreeb/format/reeb_format.h"
#include "libreeb/graph/arc_version.h"
#include "libreeb/graph/bucket.h"
#include "libreeb/graph/settled_node.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb {

// An arc record. Its nodes are numbered in the order in which the file introduces them, from 0.
struct FileArc {
  std::uint64_t lo = 0, hi = 0;
  std::uint32_t born = 0, died = kNeverDies;
  friend bool operator==(const FileArc&, const FileArc&) = default;
};

// A version that the frame completes.
struct VersionCounts {
  double persistence = 0;  // of the cancellation that made it; 0 for version 0
  std::uint64_t nodes = 0, arcs = 0, buckets = 0;
  friend bool operator==(const VersionCounts&, const VersionCounts&) = default;
};

// An object is used for one frame after the other, so that its memory is reused.
struct GraphFrame {
  std::vector<SettledNode> nodes;            // introduced here, ascending
  std::vector<FileArc> arcs;                 // by died, descending
  std::vector<VersionCounts> versions;       // completed here, from coarse to fine
  std::vector<std::uint32_t> bucket_counts;  // one entry per arc, if there is an embedding
  std::vector<Bucket> buckets;               // of all arcs, one arc after the other
  void clear();
  // The buckets of the next arc, packed as in packed_buckets.h.
  void add_buckets(std::span<const std::byte> packed);
};

// Appends the payload, with buckets if has_embedding, and with positions if has_positions.
void encode_graph_frame(const GraphFrame& frame, const FileFlags& flags, std::vector<std::byte>& out);

// Fills `frame` from a payload with the counts of `header`. Returns null, or what is wrong with the payload. Allocates
// no more than a payload of this size can need. Checks the order of nodes and of `died`, born < died, that values are
// finite and that no byte is left over. The reader checks what concerns several frames.
const char* decode_graph_frame(std::span<const std::byte> payload, const FrameHeader& header, const FileFlags& flags,
                               GraphFrame& frame);

// A persistence pair; its nodes are numbered as those of FileArc.
struct FilePair {
  std::uint64_t lo = 0, hi = 0;
  PairType type = PairType::kExt0;
  bool kept = false;
  friend bool operator==(const FilePair&, const FilePair&) = default;
};

void encode_pairs_frame(std::span<const FilePair> pairs, std::vector<std::byte>& out);
const char* decode_pairs_frame(std::span<const std::byte> payload, const FrameHeader& header,
                               std::vector<FilePair>& pairs);

}  // namespace reeb
