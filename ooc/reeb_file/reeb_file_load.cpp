// ReebFile: levels and pairs.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "ooc/reeb_file/frame_file.h"
#include "ooc/reeb_file/pair_reading.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {
namespace {

// The records that are live at one version, as the frames deliver them.
struct LiveRecords {
  std::vector<SettledNode> nodes;  // introduced so far, by file index
  std::vector<std::uint8_t> used;  // one entry per node: whether it belongs to the version
  std::vector<FileArc> arcs;
  std::vector<std::uint32_t> bucket_counts;
  std::vector<Bucket> buckets;
};

// Adds the frame. Nodes that no arc of their own frame needs are isolated points.
void add_frame(const GraphFrame& frame, std::uint32_t version, bool graph_only, bool embeds, LiveRecords& live) {
  constexpr std::uint8_t kUnreferenced = 1, kAbsent = 0, kPresent = 2;
  const std::size_t first_node = live.nodes.size();
  live.nodes.insert(live.nodes.end(), frame.nodes.begin(), frame.nodes.end());
  live.used.resize(live.nodes.size(), kUnreferenced);
  std::size_t bucket = 0;
  for (std::size_t i = 0; i < frame.arcs.size(); ++i) {
    const FileArc& arc = frame.arcs[i];
    const std::size_t count = frame.bucket_counts.empty() ? 0 : frame.bucket_counts[i];
    const bool alive = arc.born <= version && version < arc.died;
    for (const std::uint64_t end : {arc.lo, arc.hi})
      if (alive)
        live.used[end] = kPresent;
      else if (live.used[end] == kUnreferenced)
        live.used[end] = kAbsent;
    if (alive) {
      live.arcs.push_back(arc);
      if (embeds && !frame.bucket_counts.empty()) {
        live.bucket_counts.push_back(frame.bucket_counts[i]);
        live.buckets.insert(live.buckets.end(), frame.buckets.begin() + static_cast<std::ptrdiff_t>(bucket),
                            frame.buckets.begin() + static_cast<std::ptrdiff_t>(bucket + count));
      }
    }
    bucket += count;
  }
  if (graph_only) return;
  for (std::size_t i = first_node; i < live.used.size(); ++i)
    if (live.used[i] == kUnreferenced) live.used[i] = kPresent;
}

std::vector<std::uint32_t> sorted_nodes(const LiveRecords& live) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < live.nodes.size(); ++i)
    if (live.used[i] != 0) order.push_back(i);
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return live.nodes[a].key < live.nodes[b].key; };
  if (!std::ranges::is_sorted(order, before)) std::sort(order.begin(), order.end(), before);
  return order;
}

// Arcs in canonical order. Equal arcs keep the order of the file, so that each keeps its buckets.
std::vector<std::uint32_t> sorted_arcs(const std::vector<FileArc>& arcs) {
  std::vector<std::uint32_t> order(arcs.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(arcs[a].lo, arcs[a].hi) < std::tie(arcs[b].lo, arcs[b].hi);
  };
  if (!std::ranges::is_sorted(order, before)) std::stable_sort(order.begin(), order.end(), before);
  return order;
}

// Consumes the nodes.
ReebGraph nodes_by_rank(LiveRecords& live, bool positions) {
  ReebGraph graph;
  const auto order = sorted_nodes(live);
  std::vector<std::uint32_t> rank(live.nodes.size());
  graph.nodes.reserve(order.size());
  if (positions) graph.positions.reserve(order.size());
  for (const std::uint32_t node : order) {
    rank[node] = static_cast<std::uint32_t>(graph.nodes.size());
    graph.nodes.push_back(live.nodes[node].key);
    if (positions) graph.positions.push_back(live.nodes[node].position);
  }
  for (FileArc& arc : live.arcs) {
    arc.lo = rank[arc.lo];
    arc.hi = rank[arc.hi];
  }
  std::vector<SettledNode>().swap(live.nodes);
  std::vector<std::uint8_t>().swap(live.used);
  return graph;
}

void arcs_by_rank(const LiveRecords& live, ReebGraph& graph, ArcBuckets& buckets) {
  const auto order = sorted_arcs(live.arcs);
  graph.lo.reserve(order.size());
  graph.hi.reserve(order.size());
  for (const std::uint32_t i : order) {
    graph.lo.push_back(NodeId(static_cast<std::uint32_t>(live.arcs[i].lo)));
    graph.hi.push_back(NodeId(static_cast<std::uint32_t>(live.arcs[i].hi)));
  }
  if (live.bucket_counts.empty()) return;
  std::vector<std::uint64_t> first(order.size());
  std::exclusive_scan(live.bucket_counts.begin(), live.bucket_counts.end(), first.begin(), std::uint64_t{0});
  buckets.offsets.reserve(order.size() + 1);
  buckets.offsets.push_back(0);
  buckets.buckets.reserve(live.buckets.size());
  for (const std::uint32_t i : order) {
    const auto begin = live.buckets.begin() + static_cast<std::ptrdiff_t>(first[i]);
    buckets.buckets.insert(buckets.buckets.end(), begin, begin + live.bucket_counts[i]);
    buckets.offsets.push_back(buckets.buckets.size());
  }
}

}  // namespace

Level ReebFile::load(std::uint32_t version) const { return load(version, true); }

ReebGraph ReebFile::load_graph(std::uint32_t version) const { return load(version, false).graph; }

Level ReebFile::load(std::uint32_t version, bool embedded) const {
  frames_->require_version(version);
  LiveRecords live;
  GraphFrame frame;
  FrameFile::Buffers buffers;
  VersionCounts counts;
  FrameCursor cursor(*frames_);
  while (!cursor.covers(version)) {
    const std::uint32_t coarser = cursor.finest_complete();
    cursor.next(*frames_, frame, buffers);
    add_frame(frame, version, header().flags.graph_only, embedded, live);
    require_rising(*frames_, cursor, frame,
                   [&](std::uint64_t node) -> const SweepKey& { return live.nodes[node].key; });
    if (cursor.covers(version)) counts = frame.versions[coarser - 1 - version];
  }
  Level level;
  level.version = version;
  level.threshold = level_threshold(version, counts.persistence);
  level.graph = nodes_by_rank(live, embedded && header().flags.has_positions);
  arcs_by_rank(live, level.graph, level.buckets);
  require_counts(*frames_, cursor, version, counts, level.graph.node_count(), level.graph.arc_count());
  if (embedded && level.buckets.buckets.size() != counts.buckets)
    frames_->fail(frames_->end_of(cursor.frames_read()),
                  "version " + std::to_string(version) + " has another number of buckets than the file says");
  return level;
}

std::vector<PairRow> ReebFile::pairs() const {
  require_hierarchy("pairs");
  std::vector<PairRow> rows;
  read_pairs(
      *frames_, [](const SettledNode& node) { return node; },
      [&](const SettledNode& lo, const SettledNode& hi, const FilePair& pair) {
        rows.push_back({lo, hi, pair.type, pair.kept});
      });
  return rows;
}

void ReebFile::for_each_pair(const std::function<void(const PairKeys&)>& visit) const {
  require_hierarchy("pairs");
  read_pairs(
      *frames_, [](const SettledNode& node) { return node.key; },
      [&](const SweepKey& lo, const SweepKey& hi, const FilePair& pair) {
        visit({lo, hi, pair.type, pair.kept});
      });
}

}  // namespace reeb::ooc
