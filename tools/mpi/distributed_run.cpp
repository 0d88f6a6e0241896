#include "tools/mpi/distributed_run.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/parts/part_glue.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/glue_run.h"
#include "ooc/distributed/open_part_state.h"
#include "ooc/distributed/part_run.h"
#include "ooc/distributed/part_union.h"
#include "ooc/run/second_stage.h"
#include "ooc/run/stopwatch.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/library/run_options.h"
#include "tools/mpi/rank_files.h"
#include "tools/mpi/shared_names.h"
#include "tools/program/progress.h"

namespace reeb::tools {
namespace {

void write_settled(const std::string& path, ooc::PartInfo info, ooc::SegmentStore& store, const std::string& temp) {
  OpenPart none;
  none.live.path_begin = {0};
  none.live.options = info.sweep();
  if (info.sweep().bucket_exponent) none.live.bucket_begin = {0};
  info.settled_nodes = store.node_count();
  info.settled_arcs = store.arc_count();
  ooc::write_fragment(path, {io::Existing::kReplace, temp}, info, none, store);
}

// Adds what was received to what is here, without a change of what has settled.
ooc::PartInfo united(const ooc::PartInfo& here, const ooc::PartInfo& there) {
  return ooc::united_info({{"", here}, {"", there}});
}

// More than its message takes: what is stored of a node or an arc is no longer than what is held.
std::uint64_t message_bytes(const ooc::PartInfo& info, const OpenPart& open) {
  constexpr std::uint64_t kInfoBytes = 1024;
  return kInfoBytes + info.function.size() + info.runs.size() * sizeof(PartSpan) + open.live.memory_bytes() +
         open.live.nodes.size() * sizeof(PartSpan);
}

// What a rank has of the tree.
struct Live {
  ooc::PartInfo info;
  OpenPart open;
};

void send_up(World& world, std::uint32_t to, const Live& live, Reservation& passing) {
  StateBytes message;
  passing.resize(message_bytes(live.info, live.open));
  message.reserve(static_cast<std::size_t>(passing.bytes()));
  ooc::write_info(message, live.info);
  ooc::write_open_part(message, live.open);
  world.send(to, message.bytes());
}

Live receive(World& world, std::uint32_t from, std::uint32_t parts, Reservation& passing) {
  Live live;
  StateBytes message(world.receive(from, passing));
  live.info = ooc::read_info(message);
  passing.resize(2 * message.bytes().size());
  ooc::read_open_part(message, parts, live.open);
  return live;
}

// Glues what is here, and what came from another rank, if anything did. The width of buckets is that of both.
void glue(Live& here, std::optional<Live> there, ooc::SegmentStore& settled, Reservation& memory,
          Reservation& passing) {
  ooc::PartInfo info = there ? united(here.info, there->info) : here.info;
  here.open.live.removed_pairs = static_cast<std::size_t>(here.info.removed_pairs);
  PartGlue glue(settled, here.info.mesh.shares.parts, info.sweep());
  memory.resize(glue.memory_bytes_with(here.open));
  glue.add(here.open, here.info.runs);
  if (there) {
    there->open.live.removed_pairs = static_cast<std::size_t>(there->info.removed_pairs);
    memory.resize(std::max<std::uint64_t>(memory.bytes(), glue.memory_bytes_with(there->open)));
    glue.add(there->open, there->info.runs);
    there.reset();
  }
  passing.resize(0);
  here.open = {};
  memory.resize(glue.memory_bytes() + glue.copy_bytes());
  glue.copy_open(here.open);
  if (!info.sweep().bucket_exponent) here.open.live.bucket_begin.clear();
  info.removed_pairs = glue.removed_pairs();
  here.info = std::move(info);
}

// All levels of the tree in which this rank takes part. What settles goes to `file`. Returns what is known of the parts
// that it glued: of all parts at the root.
ooc::PartInfo glue_in_tree(World& world, ooc::RunContext& run, ooc::FinishedPart part, const std::string& file) {
  const std::uint32_t parts = part.info.mesh.shares.parts, rank = world.rank();
  Live live{std::move(part.info), std::move(part.open)};
  Reservation memory = run.budget.reserve("live graph", 0), passing = run.budget.reserve("messages", 0);
  ooc::SegmentStore settled(run.temp, run.budget,
                            {.allowance_bytes = run.plan.segment_bytes, .most_bytes = run.plan.most_segment_bytes});
  std::uint32_t step = 1;
  for (; step < world.size() && rank % (2 * step) == 0; step *= 2)
    if (rank + step < world.size()) glue(live, receive(world, rank + step, parts, passing), settled, memory, passing);
  if (world.is_root())
    glue(live, std::nullopt, settled, memory, passing);
  else
    send_up(world, rank - step, live, passing);
  settled.finish();
  write_settled(file, live.info, settled, run.temp.folder());
  return std::move(live.info);
}

// Of this process, as the system counts it.
void add_usage(RankFigures& figures) {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  figures.peak_bytes = peak_rss_bytes();
  for (const timeval& time : {usage.ru_utime, usage.ru_stime})
    figures.cpu_ms += static_cast<std::uint64_t>(time.tv_sec) * 1000 + static_cast<std::uint64_t>(time.tv_usec) / 1000;
}

// At the root: the figures of each rank.
std::vector<RankFigures> gather(World& world, const RankFigures& own) {
  constexpr std::size_t kFields = sizeof(RankFigures) / sizeof(std::uint64_t);
  const auto numbers = std::bit_cast<std::array<std::uint64_t, kFields>>(own);
  const std::vector<std::uint64_t> all = world.gather(numbers);
  std::vector<RankFigures> ranks(all.size() / kFields);
  for (std::size_t r = 0; r < ranks.size(); ++r) {
    std::array<std::uint64_t, kFields> one{};
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(r * kFields), kFields, one.begin());
    ranks[r] = std::bit_cast<RankFigures>(one);
  }
  return ranks;
}

void append(std::vector<std::string>& notes, const std::vector<std::string>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

struct GluedShares {
  std::vector<ooc::PartInfo> infos;  // by function
  std::vector<std::string> notes;    // of the share of this rank
};

// Computes the share of this rank, and glues it in the tree. Returns what is known of the parts that this rank glued:
// of all parts at the root.
GluedShares glue_shares(World& world, RunInput& source, std::span<const std::string> outputs,
                        const ooc::ComputeOptions& wanted, const ooc::Stopwatch& watch, RankFigures& figures) {
  std::vector<std::string> rank_outputs;
  for (const std::string& output : outputs) rank_outputs.push_back(rank_file(output, world.rank(), RankFile::kShare));
  ooc::MeshInput input = source.take_mesh();
  const ooc::ComputeOptions of_share = ooc::options_of_share(wanted);
  ooc::RunContext run(input, source.functions(), rank_outputs, of_share);
  ooc::WholeMesh mesh = ooc::open_whole_mesh(run, input, world.size());
  const std::uint64_t before = world.sent_bytes();
  ooc::PartUses uses = exchange_names(world, run, mesh);
  figures.names_bytes = world.sent_bytes() - before;
  ooc::PartResult done = ooc::run_part(run, input, mesh, uses, world.rank(), wanted);
  const ooc::Shares& shares = mesh.info.shares;
  figures.triangles = shares.end(world.rank()) - shares.begin(world.rank());
  figures.live_vertices = done.parts[0].info.live.vertices;
  figures.share_ms = static_cast<std::uint64_t>(1000 * watch.seconds());
  GluedShares glued{{}, std::move(done.notes)};
  for (std::size_t f = 0; f < outputs.size(); ++f) {
    write_settled(rank_outputs[f], done.parts[f].info, *run.stores[f], run.temp.folder());
    run.stores[f].reset();
    const std::uint64_t sent = world.sent_bytes();
    glued.infos.push_back(
        glue_in_tree(world, run, std::move(done.parts[f]), rank_file(outputs[f], world.rank(), RankFile::kTree)));
    figures.tree_bytes += world.sent_bytes() - sent;
  }
  world.wait_for_all();
  run.resumable.done();
  return glued;
}

// The second stage, at the root.
ComputeResult finish_at_root(std::uint32_t ranks, const ooc::PartInfo& info, const std::string& output,
                             const ooc::ComputeOptions& options) {
  ooc::NamedFunction function(info.function);
  VertexFunction* const functions[] = {&function};
  ooc::MeshInput none;
  none.path = "-";
  ooc::RunContext run(none, functions, std::span(&output, 1), options);
  for (std::uint32_t rank = 0; rank < ranks; ++rank)
    for (const RankFile which : {RankFile::kShare, RankFile::kTree})
      ooc::FragmentFile(rank_file(output, rank, which)).copy_settled(*run.stores[0], run.embeds());
  if (info.range.min <= info.range.max) run.values.set_ranges(std::span(&info.range, 1));
  return ooc::run_second_stage(run, ooc::first_stage_of(info), 0);
}

}  // namespace

DistributedResult compute_distributed(World& world, const std::string& path, std::span<const std::string> functions,
                                      std::span<const std::string> outputs, const ComputeOptions& options) {
  const ooc::ComputeOptions wanted = run_options(options);
  require_an_output_each(functions, outputs);
  RunInput source(path, functions, input_options(options, outputs[0]));
  if (options.opened && world.is_root()) options.opened(source.info());

  if (world.is_root())
    for (const std::string& output : outputs) remove_rank_files(output, false);
  world.wait_for_all();

  DistributedResult result;
  RankFigures figures;
  const ooc::Stopwatch watch;
  const GluedShares glued = glue_shares(world, source, outputs, wanted, watch, figures);
  figures.tree_ms = static_cast<std::uint64_t>(1000 * watch.seconds()) - figures.share_ms;
  for (std::size_t f = 0; f < outputs.size(); ++f) {
    if (world.is_root()) {
      ComputeResult written = finish_at_root(world.size(), glued.infos[f], outputs[f], wanted);
      if (f == 0) append(written.notes, glued.notes);
      append(written.notes, source.notes(f));
      written.seconds.wall += watch.seconds();
      result.results.push_back(std::move(written));
      remove_rank_files(outputs[f], true);
    }
    world.wait_for_all();
  }
  add_usage(figures);
  result.ranks = gather(world, figures);
  return result;
}

}  // namespace reeb::tools
