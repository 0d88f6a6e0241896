// GraphFileWriter: the streaming writer of graphs without hierarchy.
#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "libreeb/base/sweep_key.h"
#include "libreeb/graph/packed_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "ooc/reeb_writer/file_header.h"
#include "ooc/reeb_writer/frame_size.h"
#include "ooc/reeb_writer/reeb_file_writer.h"
#include "ooc/sorting/rank_sort.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kItemsAtOnce = 4096;

constexpr std::uint32_t kNoNode = ~std::uint32_t{0};

// How many items ahead their entries in tables are prefetched: these are anywhere in the tables.
constexpr std::size_t kAhead = 16;

FileHeader first_header(FileMeta meta, const GraphFileWriter::Options& options) {
  FileHeader header = header_of(std::move(meta));
  header.flags = file_flags(true, options.has_positions, options.has_embedding);
  header.levels.resize(1);
  return header;
}

bool in_order(const FileArc& a, const FileArc& b) { return a.lo < b.lo || (a.lo == b.lo && a.hi <= b.hi); }

}  // namespace

GraphFileWriter::GraphFileWriter(const std::string& path, FileMeta meta, const Options& options)
    : header_(first_header(std::move(meta), options)),
      writer_(path, header_.region_bytes(), options.output),
      announced_nodes_(options.nodes),
      background_(options.background),
      components_(options.nodes, options.temp, options.budget) {
  // Else they would grow step by step, each time into pages that are new to the process.
  for (GraphFrame* frame : {&frame_, &writing_}) frame->arcs.reserve(kFrameTargetBytes / kArcCost + 1);
  if (options.ends == ArcEnds::kKeys) keys_.emplace(*options.temp);
  if (options.ends == ArcEnds::kKeysInMemory)
    rank_of_.assign(static_cast<std::size_t>(std::max(options.vertex_bound, header_.mesh_vertices)), kNoNode);
}

void GraphFileWriter::add_nodes(std::span<const SettledNode> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const SettledNode& node = nodes[i];
    if (i + kAhead < nodes.size()) prefetch_rank(nodes[i + kAhead].key);
    if (last_node_ && !(*last_node_ < node.key)) throw BrokenGraph("GraphFileWriter: nodes are not ascending");
    last_node_ = node.key;
    if (keys_) keys_->append(node.key);
    if (!rank_of_.empty()) rank_of_.at(node.key.vertex.value()) = static_cast<std::uint32_t>(header_.nodes);
    frame_.nodes.push_back(node);
    if (header_.nodes == announced_nodes_) throw std::logic_error("GraphFileWriter: more nodes than announced");
    ++header_.nodes;
    flush_if_full();
  }
}

void GraphFileWriter::add_arcs(std::span<const ArcKeys> arcs, const ArcListsView& lists) {
  end_nodes();
  rank(arcs, ranked_);
  add_arcs(std::span<const FileArc>(ranked_.arcs), lists);
}

void GraphFileWriter::end_nodes() {
  if (!std::exchange(sealed_, true) && keys_) keys_->seal();
}

void GraphFileWriter::rank(std::span<const ArcKeys> arcs, RankedArcs& ranked) const {
  ranked.arcs.resize(arcs.size());
  if (keys_)
    rank_by_search(arcs, ranked);
  else
    rank_by_vertex(arcs, ranked.arcs);
}

void GraphFileWriter::rank_by_vertex(std::span<const ArcKeys> arcs, std::vector<FileArc>& ranked) const {
  const auto rank = [&](const SweepKey& key) {
    const std::uint64_t vertex = key.vertex.value();
    if (vertex >= rank_of_.size() || rank_of_[vertex] == kNoNode)
      throw BrokenGraph("GraphFileWriter: no node is vertex " + std::to_string(vertex));
    return rank_of_[vertex];
  };
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (i + kAhead < arcs.size()) prefetch_rank(arcs[i + kAhead].hi);
    if (i + kAhead < arcs.size()) prefetch_rank(arcs[i + kAhead].lo);
    ranked[i] = {rank(arcs[i].lo), rank(arcs[i].hi), 0, kNeverDies};
  }
}

void GraphFileWriter::prefetch_rank(const SweepKey& key) const {
  if (key.vertex.value() < rank_of_.size()) reeb::prefetch(&rank_of_[key.vertex.value()]);
}

// Upper ends are looked up in their own order: a large batch then touches each page of the table once, and each search
// starts near the result of the last one.
void GraphFileWriter::rank_by_search(std::span<const ArcKeys> arcs, RankedArcs& ranked) const {
  std::vector<std::uint32_t>& by_hi = ranked.by_hi;
  by_hi.resize(arcs.size());
  std::iota(by_hi.begin(), by_hi.end(), 0u);
  sort_by_rank(
      std::span(by_hi), [&](std::uint32_t arc) { return ordered_bits(arcs[arc].hi.value); },
      [&](std::uint32_t a, std::uint32_t b) { return arcs[a].hi < arcs[b].hi; });
  // The system maps a window around each page that is touched. Other look-ups might not need that window, so the pages
  // are released regularly. A look-up that goes far touches some pages on the way, in steps that double.
  constexpr std::uint64_t kWindowKeys = (64 << 10) / sizeof(SweepKey), kWindows = 32;
  std::uint64_t windows = 0;
  const auto look_up = [&](const SweepKey& key, std::uint64_t from) {
    const std::uint64_t rank = keys_->rank(key, from);
    windows += static_cast<std::uint64_t>(std::bit_width(rank / kWindowKeys - from / kWindowKeys));
    if (windows >= kWindows) {
      keys_->release_pages();
      windows = 0;
    }
    return rank;
  };
  std::uint64_t lo_rank = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    lo_rank = look_up(arcs[i].lo, lo_rank);
    ranked.arcs[i] = {lo_rank, 0, 0, kNeverDies};
  }
  std::uint64_t hi_rank = arcs.empty() ? 0 : ranked.arcs[0].lo;
  for (const std::uint32_t arc : by_hi) ranked.arcs[arc].hi = hi_rank = look_up(arcs[arc].hi, hi_rank);
  keys_->release_pages();
}

void GraphFileWriter::add_arcs(std::span<const FileArc> arcs, const ArcListsView& lists) {
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    const FileArc arc{arcs[i].lo, arcs[i].hi, 0, kNeverDies};
    if (arc.lo >= arc.hi || arc.hi >= header_.nodes || (last_arc_ && !in_order(*last_arc_, arc)))
      throw std::logic_error("GraphFileWriter: arc " + std::to_string(header_.arcs) + " is out of order");
    last_arc_ = arc;
    frame_.arcs.push_back(arc);
    ++header_.arcs;
    if (header_.flags.has_embedding) {
      frame_.add_buckets(lists.of(i));
      buckets_ += frame_.bucket_counts.back();
    }
    flush_if_full();
  }
}

void GraphFileWriter::finish() {
  frame_.versions.push_back({0.0, header_.nodes, header_.arcs, buckets_});
  flush();
  worker_.wait();
  const std::uint64_t joined = components_.joined();
  header_.components = header_.nodes - joined;
  header_.loops = header_.arcs - joined;
  header_.records = header_.arcs;
  header_.levels[0] = {.version = 0,
                       .frames = header_.graph_frames,
                       .threshold = 0,
                       .nodes = header_.nodes,
                       .arcs = header_.arcs,
                       .buckets = buckets_,
                       .file_bytes = writer_.size(),
                       .memory_bytes = level_memory(header_.nodes, header_.arcs, buckets_)};
  writer_.finish(header_);
}

void GraphFileWriter::flush_if_full() {
  if (frame_.nodes.size() * kNodeCost + frame_.arcs.size() * kArcCost + frame_.buckets.size() * kBucketCost >=
      kFrameTargetBytes)
    flush();
}

void GraphFileWriter::flush() {
  worker_.wait();
  std::swap(frame_, writing_);
  frame_.clear();
  ++header_.graph_frames;
  if (background_)
    worker_.start([this] { write(writing_); });
  else
    write(writing_);
}

void GraphFileWriter::write(const GraphFrame& frame) {
  for (std::size_t i = 0; i < frame.arcs.size(); ++i) {
    if (i + kAhead < frame.arcs.size()) components_.prefetch(frame.arcs[i + kAhead].hi);
    components_.add(frame.arcs[i].lo, frame.arcs[i].hi);
  }
  packed_.payload.clear();
  encode_graph_frame(frame, header_.flags, packed_.payload);
  packed_.pack({.kind = FrameKind::kGraph,
                .nodes = static_cast<std::uint32_t>(frame.nodes.size()),
                .records = static_cast<std::uint32_t>(frame.arcs.size()),
                .versions = static_cast<std::uint32_t>(frame.versions.size()),
                .finest = frame.versions.empty() ? 1u : 0u});
  writer_.add(packed_);
}

void write_graph_file(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                      const ArcBucketsView& buckets, const OutputOptions& output) {
  GraphFileWriter writer(path, meta,
                         {.nodes = graph.node_count(),
                          .has_positions = !graph.positions.empty(),
                          .has_embedding = !buckets.empty(),
                          .output = output});
  std::vector<SettledNode> nodes;
  for (std::size_t i = 0; i < graph.node_count(); ++i) {
    nodes.push_back({graph.nodes[i], graph.positions.empty() ? Point{} : graph.positions[i]});
    if (nodes.size() < kItemsAtOnce && i + 1 < graph.node_count()) continue;
    writer.add_nodes(nodes);
    nodes.clear();
  }
  std::vector<FileArc> arcs;
  ArcLists lists;
  for (std::size_t first = 0; first < graph.arc_count(); first += arcs.size()) {
    arcs.clear();
    const std::size_t last = std::min(first + kItemsAtOnce, graph.arc_count());
    for (std::size_t i = first; i < last; ++i)
      arcs.push_back({graph.lo[i].value(), graph.hi[i].value(), 0, kNeverDies});
    lists.clear();
    if (!buckets.empty())
      for (std::size_t i = first; i < last; ++i) lists.add(buckets.of(i));
    writer.add_arcs(std::span<const FileArc>(arcs), lists.view());
  }
  writer.finish();
}

}  // namespace reeb::ooc
