#include "ooc/reeb_file/largest_pairs.h"

#include <algorithm>
#include <functional>
#include <tuple>
#include <unordered_map>

#include "ooc/reeb_file/frame_file.h"
#include "ooc/reeb_file/pair_reading.h"

namespace reeb::ooc {
namespace {

struct Candidate {
  double persistence = 0;
  std::uint64_t number = 0;  // in the file
  FilePair pair;
};

// The one that is dropped first is the least.
bool larger(const Candidate& a, const Candidate& b) {
  return std::tie(b.persistence, a.number) < std::tie(a.persistence, b.number);
}

// Fills loops and counts. Returns the candidates of the rows.
std::vector<Candidate> scan_pairs(const FrameFile& file, std::size_t most, LargestPairs& result) {
  std::vector<Candidate> heap;
  std::uint64_t number = 0;
  read_pairs(
      file, [](const SettledNode& node) { return node.key.value; },
      [&](double lo, double hi, const FilePair& pair) {
        const double persistence = hi - lo;
        ++result.counts[static_cast<std::size_t>(pair.type)];
        if (pair.type == PairType::kExt1) result.loops.push_back(persistence);
        heap.push_back({persistence, number++, pair});
        std::push_heap(heap.begin(), heap.end(), larger);
        if (heap.size() <= most) return;
        std::pop_heap(heap.begin(), heap.end(), larger);
        heap.pop_back();
      });
  return heap;
}

// Nodes that live long come first in the file, so this rarely reads all of it.
std::unordered_map<std::uint64_t, SettledNode> read_nodes(const FrameFile& file,
                                                          const std::vector<Candidate>& candidates) {
  std::unordered_map<std::uint64_t, SettledNode> nodes;
  for (const Candidate& candidate : candidates) nodes[candidate.pair.lo] = nodes[candidate.pair.hi] = {};
  std::size_t missing = nodes.size();
  GraphFrame frame;
  FrameFile::Buffers buffers;
  for (FrameCursor cursor(file); missing > 0;) {
    const std::uint64_t first = cursor.nodes_read();
    cursor.next(file, frame, buffers);
    for (std::size_t i = 0; i < frame.nodes.size(); ++i) {
      const auto found = nodes.find(first + i);
      if (found == nodes.end()) continue;
      found->second = frame.nodes[i];
      --missing;
    }
  }
  return nodes;
}

}  // namespace

LargestPairs read_largest_pairs(const std::string& path, std::size_t most) {
  const FrameFile file(path);
  if (file.header().flags.graph_only)
    throw Error(ErrorKind::kBadInput, "the file has the graph only, no pairs", "compute it again without --graph-only")
        .at(path);
  LargestPairs result;
  const std::vector<Candidate> candidates = scan_pairs(file, most, result);
  std::ranges::sort(result.loops, std::greater<>());
  const auto nodes = read_nodes(file, candidates);
  for (const auto& [persistence, number, pair] : candidates)
    result.rows.push_back({nodes.at(pair.lo), nodes.at(pair.hi), pair.type, pair.kept});
  const auto key = [](const PairRow& row) {
    return std::tuple(row.lo.key.value - row.hi.key.value, row.type, row.lo.key.vertex, row.hi.key.vertex);
  };
  std::ranges::sort(result.rows, [&](const PairRow& a, const PairRow& b) { return key(a) < key(b); });
  return result;
}

}  // namespace reeb::ooc
