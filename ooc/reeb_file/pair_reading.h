// Reads the pairs of a `.reeb` file with their nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/format/frame_codec.h"
#include "libreeb/graph/settled_node.h"
#include "ooc/reeb_file/frame_file.h"

namespace reeb::ooc {

// What is held of a node, as far as pairs are ordered by it.
inline const SweepKey& pair_key(const SettledNode& node) { return node.key; }
inline const SweepKey& pair_key(const SweepKey& node) { return node; }
inline double pair_key(double value) { return value; }

// Calls visit(lo, hi, pair) for each pair, in the order of the file; make(node) is what is held of a node.
// THROWS: Error{kBadInput} where a pair does not go up, or pairs are missing.
template <class Make, class Visit>
void read_pairs(const FrameFile& file, const Make& make, const Visit& visit) {
  const FileHeader& header = file.header();
  std::vector<decltype(make(SettledNode{}))> nodes;
  GraphFrame frame;
  FrameFile::Buffers buffers;
  for (FrameCursor cursor(file); cursor.frames_read() < header.graph_frames;) {
    cursor.next(file, frame, buffers);
    for (const SettledNode& node : frame.nodes) nodes.push_back(make(node));
  }
  std::uint64_t count = 0;
  std::vector<FilePair> pairs;
  for (std::size_t i = header.graph_frames; i < std::size_t{header.graph_frames} + header.pair_frames; ++i) {
    FrameHeader frame_header;
    const auto payload = file.read_frame(i, frame_header, buffers);
    const std::uint64_t offset = file.frame_offset(i);
    if (const char* why = decode_pairs_frame(payload, frame_header, pairs)) file.fail(offset, why);
    for (const FilePair& pair : pairs) {
      if (pair.lo >= nodes.size() || pair.hi >= nodes.size() || pair_key(nodes[pair.hi]) < pair_key(nodes[pair.lo]))
        file.fail(offset, "a pair does not go up to a node");
      visit(nodes[pair.lo], nodes[pair.hi], pair);
    }
    count += pairs.size();
  }
  if (count != header.pairs) file.fail(0, "there are not as many pairs as the header says");
}

}  // namespace reeb::ooc
