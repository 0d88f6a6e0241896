#include "tools/mpi/distributed_run.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

#include "io/file/atomic_file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/parts/part_glue.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/glue_run.h"
#include "ooc/distributed/open_part_state.h"
#include "ooc/distributed/part_run.h"
#include "ooc/run/second_stage.h"
#include "ooc/run/stopwatch.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/library/run_options.h"
#include "tools/mpi/shared_names.h"

namespace reeb::tools {
namespace {

// What travels up the tree.
class Message : public StateWriter, public StateReader {
 public:
  explicit Message(std::vector<std::byte> bytes = {}) : bytes_(std::move(bytes)) {}
  void write(std::span<const std::byte> more) override { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
  void read(std::span<std::byte> out) override {
    if (out.size() > left()) throw DamagedState();
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), out.size(), out.begin());
    at_ += out.size();
  }
  std::uint64_t left() const override { return bytes_.size() - at_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
};

// The files of a rank: what settled in its share, and what settled while it glued.
std::string rank_file(const std::string& output, std::uint32_t rank, const char* what) {
  return output + ".rank-" + std::to_string(rank) + "-" + what + ".fragment";
}
constexpr const char *kOfShare = "share", *kOfTree = "tree";

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

struct Glued {
  ooc::PartInfo info;
  std::uint64_t sent_bytes = 0;
};

// All levels of the tree in which this rank takes part. The widths of buckets are known at each level only.
Glued glue_in_tree(World& world, ooc::RunContext& run, ooc::FinishedPart part, const std::string& file) {
  const std::uint32_t parts = part.info.mesh.shares.parts;
  Glued glued{part.info, 0};
  OpenPart open = std::move(part.open);
  Reservation memory = run.budget.reserve("live graph", 0);
  ooc::SegmentStore settled(run.temp, run.budget,
                            {.allowance_bytes = run.plan.segment_bytes, .most_bytes = run.plan.most_segment_bytes});
  const std::uint64_t before = world.sent_bytes();
  for (std::uint32_t step = 1;; step *= 2) {
    const bool is_last = step >= world.size();
    if (!is_last && world.rank() % (2 * step) == 0 && world.rank() + step >= world.size()) continue;
    if (!is_last && world.rank() % (2 * step) != 0) {
      Message message;
      ooc::write_info(message, glued.info);
      ooc::write_open_part(message, open);
      world.send(world.rank() - step, message.bytes());
      break;
    }
    ooc::PartInfo info = glued.info;
    OpenPart other;
    std::vector<PartSpan> other_runs;
    if (!is_last) {
      Message message(world.receive(world.rank() + step));
      const ooc::PartInfo there = ooc::read_info(message);
      ooc::read_open_part(message, parts, other);
      other.live.removed_pairs = static_cast<std::size_t>(there.removed_pairs);
      other_runs = there.runs;
      info = united(glued.info, there);
    }
    open.live.removed_pairs = static_cast<std::size_t>(glued.info.removed_pairs);
    PartGlue glue(settled, parts, info.sweep());
    memory.resize(glue.memory_bytes_with(open));
    glue.add(open, glued.info.runs);
    if (!is_last) {
      memory.resize(std::max<std::uint64_t>(memory.bytes(), glue.memory_bytes_with(other)));
      glue.add(other, other_runs);
    }
    glue.copy_open(open);
    if (!info.sweep().bucket_exponent) open.live.bucket_begin.clear();
    info.removed_pairs = glue.removed_pairs();
    glued.info = std::move(info);
    if (is_last) break;
  }
  glued.sent_bytes = world.sent_bytes() - before;
  settled.finish();
  write_settled(file, glued.info, settled, run.temp.folder());
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
    for (const char* what : {kOfShare, kOfTree})
      ooc::FragmentFile(rank_file(output, rank, what)).copy_settled(*run.stores[0], run.embeds());
  if (info.range.min <= info.range.max) run.values.set_ranges(std::span(&info.range, 1));
  return ooc::run_second_stage(run, ooc::first_stage_of(info), 0);
}

}  // namespace

DistributedResult compute_distributed(World& world, const std::string& path, std::span<const std::string> functions,
                                      std::span<const std::string> outputs, const ComputeOptions& options) {
  const ooc::ComputeOptions wanted = run_options(options);
  const ooc::ComputeOptions of_share = ooc::options_of_share(wanted);
  RunInput source(path, functions,
                  {.format = options.format,
                   .image = options.image,
                   .temp_dir = options.temp_dir.empty() ? io::TempDir::default_folder(outputs[0]) : options.temp_dir,
                   .memory_bytes = options.memory_bytes});
  if (options.opened && world.is_root()) options.opened(source.info());
  ooc::MeshInput input = source.take_mesh();
  std::vector<std::string> rank_outputs;
  for (const std::string& output : outputs) rank_outputs.push_back(rank_file(output, world.rank(), kOfShare));

  DistributedResult result;
  std::vector<ooc::PartInfo> infos;
  const ooc::Stopwatch watch;
  {
    ooc::RunContext run(input, source.functions(), rank_outputs, of_share);
    ooc::WholeMesh mesh = ooc::open_whole_mesh(run, input, world.size());
    const std::uint64_t before = world.sent_bytes();
    ooc::PartUses uses = exchange_names(world, run, mesh);
    result.names_bytes = world.sent_bytes() - before;
    ooc::PartResult done = ooc::run_part(run, input, mesh, uses, world.rank(), wanted);
    result.share_seconds = watch.seconds();
    for (std::size_t f = 0; f < outputs.size(); ++f) {
      write_settled(rank_outputs[f], done.parts[f].info, *run.stores[f], run.temp.folder());
      run.stores[f].reset();
      Glued glued = glue_in_tree(world, run, std::move(done.parts[f]), rank_file(outputs[f], world.rank(), kOfTree));
      result.tree_bytes += glued.sent_bytes;
      infos.push_back(std::move(glued.info));
    }
    world.wait_for_all();
    run.resumable.done();
  }
  result.tree_seconds = watch.seconds() - result.share_seconds;
  for (std::size_t f = 0; f < outputs.size(); ++f) {
    if (world.is_root()) {
      ComputeResult written = finish_at_root(world.size(), infos[f], outputs[f], wanted);
      written.seconds.wall += watch.seconds();
      result.results.push_back(std::move(written));
    }
    world.wait_for_all();
    for (const char* what : {kOfShare, kOfTree}) std::remove(rank_file(outputs[f], world.rank(), what).c_str());
  }
  return result;
}

}  // namespace reeb::tools
