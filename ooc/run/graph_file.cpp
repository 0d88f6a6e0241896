#include "ooc/run/graph_file.h"

#include <algorithm>
#include <span>
#include <vector>

#include "libreeb/base/count_text.h"
#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {

Poll stage_poll(const RunContext& run) {
  return [&run](double done) {
    constexpr std::uint64_t kSteps = 10000;
    run.tell({ComputeProgress::Phase::kHierarchy, static_cast<std::uint64_t>(done * kSteps), kSteps});
  };
}

WrittenGraph write_graph(RunContext& run, const StoredGraph& graph, const FileMeta& meta) {
  constexpr std::size_t kNodesAtOnce = 4096, kBytesPerArc = 1000, kVerticesPerNodeForTable = 16;
  SegmentStore& store = *graph.store;
  GraphFileWriter::Options writing{.nodes = store.node_count(),
                                   .has_embedding = run.embeds(),
                                   .ends = GraphFileWriter::ArcEnds::kKeys,
                                   .vertex_bound = graph.vertex_bound,
                                   .background = run.background(),
                                   .temp = &run.temp,
                                   .budget = &run.budget,
                                   .output = run.output_options()};
  const std::uint64_t table_bytes = graph.vertex_bound * sizeof(std::uint32_t);
  Reservation table;
  if (graph.vertex_bound / kVerticesPerNodeForTable <= store.node_count() &&
      table_bytes <= run.budget.free_bytes() / 4) {
    table = run.budget.reserve("ranks of nodes", table_bytes);
    writing.ends = GraphFileWriter::ArcEnds::kKeysInMemory;
  }
  GraphFileWriter writer(graph.output, meta, writing);
  // Only the look-up in a file gains from large batches. There must be several, so that threads share the work.
  constexpr std::size_t kFewestArcs = 4096, kBatches = 16;
  const std::size_t most_arcs = std::clamp<std::size_t>(run.budget.free_bytes() / kBytesPerArc, kFewestArcs, 65536);
  const std::size_t batch_arcs =
      table.bytes() != 0 ? 8192
                         : std::clamp(static_cast<std::size_t>(store.arc_count() / kBatches), kFewestArcs, most_arcs);
  std::uint64_t written = 0;
  const Poll poll = stage_poll(run);
  const auto tell = [&](std::uint64_t more) {
    written += more;
    poll(static_cast<double>(written) / static_cast<double>(store.node_count() + store.arc_count()));
  };
  store.rewind_nodes();
  read_ahead<std::vector<SettledNode>>(
      writing.background, [&](auto& nodes) { return store.read_nodes(nodes, kNodesAtOnce); },
      [&](const auto& nodes) {
        writer.add_nodes(nodes);
        tell(nodes.size());
      });
  writer.end_nodes();
  store.rewind_arcs();
  struct Arcs {
    ArcPiece piece;
    GraphFileWriter::RankedArcs ranked;
  };
  read_ahead<Arcs>(
      writing.background,
      [&](Arcs& arcs) { return store.read_arcs(arcs.piece, batch_arcs, graph.sweep.bucket_exponent); },
      [&](Arcs& arcs) { writer.rank(arcs.piece.arcs, arcs.ranked); },
      [&](const Arcs& arcs) {
        writer.add_arcs(std::span<const FileArc>(arcs.ranked.arcs), arcs.piece.lists.view());
        tell(arcs.piece.arcs.size());
      });
  writer.finish();
  return {{writer.header().components, writer.header().loops}, writer.spilled_bytes()};
}

Error no_memory_for(const RunContext& run, const std::string& what, const std::string& output, std::uint64_t arcs,
                    NeededBytes needed, const std::string& otherwise) {
  const auto size = [&](std::uint64_t bytes) {
    // Reading what is stored takes up to a quarter of the budget.
    const std::uint64_t enough = run.plan.set_aside_bytes + (run.budget.used_bytes() + bytes) / 3 * 4;
    return std::to_string(enough / (1 << 20) + 1) + "M";
  };
  std::string range = "up to " + format_bytes(needed.most), enough = size(needed.most);
  if (needed.least < needed.most) {
    range = format_bytes(needed.least) + " to " + format_bytes(needed.most);
    enough += " (" + size(needed.least) + " may be enough)";
  }
  Error error(ErrorKind::kResource,
              what + " of " + count_of(arcs, "arc") + " needs " + range + " of memory, but only " +
                  format_bytes(run.budget.free_bytes()) + " is left; the graph itself was written",
              "with --force, since the graph is there: allow --memory " + enough + ", or " + otherwise);
  return error.at(output).because(ErrorCause::kMemory);
}

}  // namespace reeb::ooc
