// write_hierarchy_file: frames as HierarchyLayout planned them.
#include <algorithm>
#include <limits>

#include "ooc/file_header.h"
#include "ooc/frame_size.h"
#include "ooc/hierarchy_layout.h"
#include "ooc/reeb_file_writer.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kNotIntroduced = std::numeric_limits<std::uint64_t>::max();

class HierarchyFileWriter {
 public:
  HierarchyFileWriter(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                      const Hierarchy& hierarchy, const ArcBucketsView& buckets)
      : graph_(graph),
        hierarchy_(hierarchy),
        buckets_(buckets),
        layout_(lay_out(graph, hierarchy, buckets)),
        header_(make_header(meta)),
        writer_(path, header_.region_bytes()),
        file_index_(graph.node_count(), kNotIntroduced) {}

  void run() {
    std::vector<std::uint64_t> frame_ends;
    FrameCut before{0, 0, header_.steps + 1};
    for (const FrameCut& cut : layout_.cuts) {
      write_graph_frame(before, cut);
      frame_ends.push_back(writer_.size());
      before = cut;
    }
    for (LevelLine& level : header_.levels) level.file_bytes = frame_ends[level.frames - 1];
    write_pairs();
    writer_.finish(header_);
  }

 private:
  FileHeader make_header(const FileMeta& meta) const {
    FileHeader header = header_of(meta);
    header.flags = {false, !graph_.positions.empty(), !buckets_.empty()};
    header.nodes = graph_.node_count();
    header.arcs = graph_.arc_count();
    const BettiNumbers betti = betti_numbers(graph_);
    header.components = betti.components;
    header.loops = betti.loops;
    header.records = hierarchy_.arcs.size();
    header.pairs = hierarchy_.pairs.size();
    header.kept_loops = static_cast<std::uint64_t>(
        std::ranges::count_if(hierarchy_.pairs, [](const PersistencePair& pair) { return pair.kept; }));
    header.steps = static_cast<std::uint32_t>(hierarchy_.persistence.size());
    header.graph_frames = static_cast<std::uint32_t>(layout_.cuts.size());
    header.pair_frames =
        static_cast<std::uint32_t>((hierarchy_.pairs.size() + kPairsPerFrame - 1) / kPairsPerFrame);
    header.levels = layout_.levels;
    return header;
  }

  void write_graph_frame(const FrameCut& before, const FrameCut& cut) {
    frame_.clear();
    introduce_nodes(before, cut);
    for (std::size_t i = before.record_end; i < cut.record_end; ++i) {
      const std::uint32_t record = layout_.order[i];
      const ArcVersion& arc = hierarchy_.arcs[record];
      frame_.arcs.push_back({file_index_[arc.lo.value()], file_index_[arc.hi.value()], arc.born, arc.died});
      if (!buckets_.empty()) frame_.add_buckets(buckets_.of(record));
    }
    for (std::uint32_t version = before.finest; version > cut.finest; --version)
      frame_.versions.push_back(layout_.versions[version - 1]);

    payload_.clear();
    encode_graph_frame(frame_, header_.flags, payload_);
    writer_.add({.kind = FrameKind::kGraph,
                 .nodes = static_cast<std::uint32_t>(frame_.nodes.size()),
                 .records = static_cast<std::uint32_t>(frame_.arcs.size()),
                 .versions = static_cast<std::uint32_t>(frame_.versions.size()),
                 .finest = cut.finest},
                payload_);
  }

  // The nodes that this frame is the first to need, ascending.
  void introduce_nodes(const FrameCut& before, const FrameCut& cut) {
    new_nodes_.assign(layout_.isolated.begin() + static_cast<std::ptrdiff_t>(before.isolated_end),
                      layout_.isolated.begin() + static_cast<std::ptrdiff_t>(cut.isolated_end));
    for (std::size_t i = before.record_end; i < cut.record_end; ++i) {
      const ArcVersion& arc = hierarchy_.arcs[layout_.order[i]];
      for (const NodeId end : {arc.lo, arc.hi})
        if (file_index_[end.value()] == kNotIntroduced) new_nodes_.push_back(end.value());
    }
    std::sort(new_nodes_.begin(), new_nodes_.end());
    new_nodes_.erase(std::unique(new_nodes_.begin(), new_nodes_.end()), new_nodes_.end());
    for (const std::uint32_t node : new_nodes_) {
      file_index_[node] = introduced_++;
      frame_.nodes.push_back(
          {graph_.nodes[node], graph_.positions.empty() ? Point{} : graph_.positions[node]});
    }
  }

  void write_pairs() {
    std::vector<FilePair> pairs;
    for (std::size_t i = 0; i < hierarchy_.pairs.size(); ++i) {
      const PersistencePair& pair = hierarchy_.pairs[i];
      pairs.push_back({file_index_[pair.lo.value()], file_index_[pair.hi.value()], pair.type, pair.kept});
      if (pairs.size() < kPairsPerFrame && i + 1 < hierarchy_.pairs.size()) continue;
      payload_.clear();
      encode_pairs_frame(pairs, payload_);
      writer_.add({.kind = FrameKind::kPairs, .nodes = static_cast<std::uint32_t>(pairs.size())}, payload_);
      pairs.clear();
    }
  }

  const ReebGraph& graph_;
  const Hierarchy& hierarchy_;
  const ArcBucketsView buckets_;
  const HierarchyLayout layout_;
  FileHeader header_;
  FrameWriter writer_;
  std::vector<std::uint64_t> file_index_;  // of nodes: their order of introduction
  std::uint64_t introduced_ = 0;
  std::vector<std::uint32_t> new_nodes_;
  GraphFrame frame_;
  std::vector<std::byte> payload_;
};

}  // namespace

void write_hierarchy_file(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                          const Hierarchy& hierarchy, const ArcBucketsView& buckets) {
  check_hierarchy(graph, hierarchy, buckets);
  HierarchyFileWriter(path, meta, graph, hierarchy, buckets).run();
}

}  // namespace reeb::ooc
