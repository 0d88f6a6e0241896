// Writes `.reeb` files (docs/FORMAT.md). The bytes depend on the arguments only: they contain no times and no paths.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "libreeb/format/frame_codec.h"
#include "libreeb/format/reeb_format.h"
#include "libreeb/graph/arc_buckets.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/cancel.h"
#include "libreeb/hierarchy/hierarchy.h"
#include "libreeb/port/graph_sink.h"
#include "ooc/reeb_writer/frame_writer.h"
#include "ooc/reeb_writer/hierarchy_source.h"
#include "ooc/reeb_writer/record_source.h"
#include "ooc/tables/component_count.h"
#include "ooc/tables/key_table.h"
#include "ooc/threads/worker.h"

namespace reeb::ooc {

// What a file records about the run that made it.
struct FileMeta {
  std::string function = "z";
  double function_min = 0, function_max = 0;
  std::uint64_t mesh_vertices = 0, mesh_triangles = 0;
  double denoise_threshold = 0;
  std::uint64_t denoised_pairs = 0;
  std::int32_t bucket_exponent = 0;
};

// A graph with all its levels.
struct HierarchyContent {
  HierarchySource& hierarchy;
  RecordSource& records;
  bool has_embedding = false;  // records come with buckets
  bool background = false;     // two threads make, pack and write frames
  OutputOptions output = {};
};

// Reads the records twice, first without their buckets. `poll` is called before every frame; it may throw to stop
// writing.
// MEMORY: hierarchy_file_bytes().
// THROWS: Error{kResource}; then no file is left. std::logic_error if graph, hierarchy and records contradict each
//         other.
void write_hierarchy_file(const std::string& path, const FileMeta& meta, const HierarchyContent& content,
                          const Poll& poll = {});
// The most memory that it holds: 32 bytes per version, 4 1/8 per node, and frames.
std::uint64_t hierarchy_file_bytes(std::uint64_t nodes, std::uint64_t versions);

// The same from memory: hierarchy.arcs in any order, with their buckets or none. It needs 4 more bytes per record.
void write_hierarchy_file(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                          const Hierarchy& hierarchy, const ArcBucketsView& buckets = {});

// A graph without hierarchy, from memory. Writes the same bytes as GraphFileWriter.
void write_graph_file(const std::string& path, const FileMeta& meta, const ReebGraph& graph,
                      const ArcBucketsView& buckets = {}, const OutputOptions& output = {});

// A graph without hierarchy that need not fit in memory: add its nodes in batches, then its arcs in batches, then call
// finish(). The file appears at finish(). Its bytes do not depend on the batches.
// MEMORY: two frames and 16 bytes per frame; what ArcEnds says; reserved: 4 bytes per node, or as ComponentCount.
// THROWS: Error{kResource}, also that of an earlier frame; std::logic_error for items out of order.
class GraphFileWriter {
 public:
  // How arcs name their nodes.
  enum class ArcEnds {
    kRanks,
    kKeys,          // looked up in a temporary file of 16 bytes per node
    kKeysInMemory,  // looked up in 4 bytes per vertex of the mesh
  };
  struct Options {
    std::uint64_t nodes = 0;  // the number of nodes that will be added
    bool has_positions = true;
    bool has_embedding = false;
    ArcEnds ends = ArcEnds::kRanks;
    std::uint64_t vertex_bound = 0;     // for kKeysInMemory: more than the index of any vertex; else their number is
    bool background = false;            // pack and write frames in a separate thread
    const io::TempDir* temp = nullptr;  // REQUIRED for kKeys
    MemoryBudget* budget = nullptr;     // requires `temp`; null: memory is not counted
    OutputOptions output = {};
  };
  // Arcs whose ends are ranks of nodes, with memory to find these.
  struct RankedArcs {
    std::vector<FileArc> arcs;
    std::vector<std::uint32_t> by_hi;
  };

  GraphFileWriter(const std::string& path, FileMeta meta, const Options& options);

  // REQUIRES: ascending, over all calls.
  void add_nodes(std::span<const SettledNode> nodes);

  // No nodes follow. Needed before rank() only.
  void end_nodes();
  // Looks up the ends of arcs. Faster in large batches that are ascending (28 bytes per arc of the batch).
  // REQUIRES: end_nodes() was called; kKeys or kKeysInMemory.   THREADS: any number at a time.
  void rank(std::span<const ArcKeys> arcs, RankedArcs& ranked) const;

  // Looks up, too.
  // REQUIRES: after all nodes; ascending by (lo, hi), over all calls; lo below hi. With an embedding, `lists` has
  //           those of this batch.
  void add_arcs(std::span<const ArcKeys> arcs, const ArcListsView& lists = {});
  // The same, with the ends given as ranks of nodes.
  void add_arcs(std::span<const FileArc> arcs, const ArcListsView& lists = {});

  void finish();
  // The header that was written; complete after finish().
  const FileHeader& header() const { return header_; }
  // Bytes written to temporary files.
  std::uint64_t spilled_bytes() const { return components_.spilled_bytes() + (keys_ ? keys_->spilled_bytes() : 0); }

 private:
  void rank_by_vertex(std::span<const ArcKeys> arcs, std::vector<FileArc>& ranked) const;
  void prefetch_rank(const SweepKey& key) const;
  void rank_by_search(std::span<const ArcKeys> arcs, RankedArcs& ranked) const;
  void flush_if_full();
  void flush();
  void write(const GraphFrame& frame);

  FileHeader header_;
  FrameWriter writer_;
  std::uint64_t announced_nodes_;
  bool background_;
  std::optional<KeyTable> keys_;
  std::vector<std::uint32_t> rank_of_;  // by vertex
  GraphFrame frame_, writing_;
  PackedFrame packed_;
  RankedArcs ranked_;
  std::optional<SweepKey> last_node_;
  std::optional<FileArc> last_arc_;
  ComponentCount components_;
  std::uint64_t buckets_ = 0;
  bool sealed_ = false;
  Worker worker_;  // writes writing_; the last member, so that it is destroyed first
};

}  // namespace reeb::ooc
