// write_hierarchy_file: frames as HierarchyLayout planned them.
#include <algorithm>

#include "libreeb/base/prefetch.h"
#include "ooc/reeb_writer/file_header.h"
#include "ooc/reeb_writer/frame_size.h"
#include "ooc/reeb_writer/hierarchy_layout.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {
namespace {

constexpr std::uint32_t kNotIntroduced = ~std::uint32_t{0}, kNoted = kNotIntroduced - 1;  // instead of an index

class HierarchyFileWriter {
 public:
  HierarchyFileWriter(const std::string& path, const FileMeta& meta, const HierarchyContent& content)
      : hierarchy_(content.hierarchy),
        records_(content.records),
        layout_(lay_out(hierarchy_, records_, content.background)),
        header_(make_header(meta, content)),
        writer_(path, header_.region_bytes(), content.output),
        background_(content.background),
        file_index_(hierarchy_.node_count(), kNotIntroduced) {}

  void run(const Poll& poll) {
    std::vector<std::uint64_t> frame_ends;
    records_.rewind(RecordSource::Buckets::kRead);
    std::size_t next = 0;
    read_ahead<PlannedFrame>(
        background_, [&](PlannedFrame& frame) { return next < layout_.cuts.size() && (make(next++, frame), true); },
        [&](PlannedFrame& frame) { pack(frame); },
        [&](const PlannedFrame& frame) {
          if (poll) poll(static_cast<double>(frame_ends.size()) / static_cast<double>(layout_.cuts.size()));
          writer_.add(frame.packed);
          frame_ends.push_back(writer_.size());
        });
    for (LevelLine& level : header_.levels) level.file_bytes = frame_ends[level.frames - 1];
    write_pairs();
    writer_.finish(header_);
  }

 private:
  struct PlannedFrame {
    GraphFrame frame;
    std::uint32_t finest = 0;  // version
    PackedFrame packed;
  };

  FileHeader make_header(const FileMeta& meta, const HierarchyContent& content) {
    FileHeader header = header_of(meta);
    header.flags = file_flags(false, hierarchy_.has_positions(), content.has_embedding);
    header.nodes = hierarchy_.node_count();
    header.arcs = layout_.versions[0].arcs;
    header.records = layout_.records;
    hierarchy_.rewind_pairs();
    for (PersistencePair pair; hierarchy_.next_pair(pair); ++header.pairs) {
      header.components += pair.type == PairType::kExt0 ? 1 : 0;
      header.loops += pair.type == PairType::kExt1 ? 1 : 0;
      header.kept_loops += pair.kept ? 1 : 0;
    }
    header.steps = static_cast<std::uint32_t>(hierarchy_.persistence().size());
    header.graph_frames = static_cast<std::uint32_t>(layout_.cuts.size());
    header.pair_frames = static_cast<std::uint32_t>((header.pairs + kPairsPerFrame - 1) / kPairsPerFrame);
    header.levels = layout_.levels;
    return header;
  }

  void make(std::size_t number, PlannedFrame& planned) {
    const FrameCut before = number == 0 ? FrameCut{0, 0, header_.steps + 1} : layout_.cuts[number - 1];
    const FrameCut& cut = layout_.cuts[number];
    GraphFrame& frame = planned.frame;
    frame.clear();
    read_records(cut.record_end - before.record_end, frame);
    introduce_nodes(before, cut, frame);
    for (const ArcVersion& arc : arcs_)
      frame.arcs.push_back({file_index_[arc.lo.value()], file_index_[arc.hi.value()], arc.born, arc.died});
    for (std::uint32_t version = before.finest; version > cut.finest; --version)
      frame.versions.push_back(layout_.versions[version - 1]);
    planned.finest = cut.finest;
  }

  void pack(PlannedFrame& planned) const {
    const GraphFrame& frame = planned.frame;
    planned.packed.payload.clear();
    encode_graph_frame(frame, header_.flags, planned.packed.payload);
    planned.packed.pack({.kind = FrameKind::kGraph,
                         .nodes = static_cast<std::uint32_t>(frame.nodes.size()),
                         .records = static_cast<std::uint32_t>(frame.arcs.size()),
                         .versions = static_cast<std::uint32_t>(frame.versions.size()),
                         .finest = planned.finest});
  }

  // The next records with their buckets.
  void read_records(std::uint64_t count, GraphFrame& frame) {
    arcs_.clear();
    for (PackedRecord record; arcs_.size() < count && records_.next(record);) {
      arcs_.push_back(record.arc);
      for (const NodeId end : {record.arc.lo, record.arc.hi}) prefetch(&file_index_[end.value()]);
      if (header_.flags.has_embedding) frame.add_buckets(record.buckets);
    }
  }

  // The nodes that this frame is the first to name, ascending.
  void introduce_nodes(const FrameCut& before, const FrameCut& cut, GraphFrame& frame) {
    new_nodes_.clear();
    for (std::size_t i = before.isolated_end; i < cut.isolated_end; ++i)
      new_nodes_.push_back(hierarchy_.isolated()[i].value());
    for (const ArcVersion& arc : arcs_)
      for (const NodeId end : {arc.lo, arc.hi})
        if (file_index_[end.value()] == kNotIntroduced) {
          file_index_[end.value()] = kNoted;
          new_nodes_.push_back(end.value());
          hierarchy_.prefetch(end);
        }
    std::sort(new_nodes_.begin(), new_nodes_.end());
    for (const std::uint32_t node : new_nodes_) {
      file_index_[node] = introduced_++;
      frame.nodes.push_back(hierarchy_.node(NodeId(node)));
    }
  }

  void write_pairs() {
    hierarchy_.rewind_pairs();
    struct PlannedPairs {
      std::vector<FilePair> pairs;
      PackedFrame packed;
    };
    read_ahead<PlannedPairs>(
        background_,
        [&](PlannedPairs& planned) {
          planned.pairs.clear();
          for (PersistencePair pair; planned.pairs.size() < kPairsPerFrame && hierarchy_.next_pair(pair);)
            planned.pairs.push_back({file_index_[pair.lo.value()], file_index_[pair.hi.value()], pair.type, pair.kept});
          return !planned.pairs.empty();
        },
        [&](PlannedPairs& planned) {
          planned.packed.payload.clear();
          encode_pairs_frame(planned.pairs, planned.packed.payload);
          planned.packed.pack({.kind = FrameKind::kPairs, .nodes = static_cast<std::uint32_t>(planned.pairs.size())});
        },
        [&](const PlannedPairs& planned) { writer_.add(planned.packed); });
  }

  HierarchySource& hierarchy_;
  RecordSource& records_;
  const HierarchyLayout layout_;
  FileHeader header_;
  FrameWriter writer_;
  const bool background_;
  std::vector<std::uint32_t> file_index_;  // by node: its place in the order of introduction
  std::uint32_t introduced_ = 0;
  std::vector<ArcVersion> arcs_;  // of the current frame
  std::vector<std::uint32_t> new_nodes_;
};

}  // namespace

void write_hierarchy_file(const std::string& path, const FileMeta& meta, const HierarchyContent& content,
                          const Poll& poll) {
  HierarchyFileWriter(path, meta, content).run(poll);
}

std::uint64_t hierarchy_file_bytes(std::uint64_t nodes, std::uint64_t versions) {
  constexpr std::uint64_t kFrames = 3 << 20;
  return sizeof(VersionCounts) * versions + sizeof(std::uint32_t) * nodes + nodes / 8 + kFrames;
}

void write_hierarchy_file(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                          const Hierarchy& hierarchy, const ArcBucketsView& buckets) {
  SortedRecords records(hierarchy.arcs, buckets);
  HierarchyInMemory in_memory(graph, hierarchy);
  write_hierarchy_file(path, meta, {in_memory, records, !buckets.empty()});
}

}  // namespace reeb::ooc
