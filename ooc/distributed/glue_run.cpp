#include "ooc/distributed/glue_run.h"

#include <algorithm>
#include <utility>

#include "io/file/atomic_file.h"
#include "libreeb/base/error.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/parts/part_glue.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/part_union.h"
#include "ooc/run/explained_error.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/glued_chunks.h"
#include "ooc/run/run_context.h"
#include "ooc/run/second_stage.h"
#include "ooc/run/stopwatch.h"

namespace reeb::ooc {
namespace {

std::vector<NamedPart> read_infos(std::span<const std::string> fragments) {
  std::vector<NamedPart> parts;
  for (const std::string& path : fragments) parts.push_back({path, FragmentFile(path).info()});
  return parts;
}

void check_buckets(const NamedPart& first, const GlueOptions& options) {
  if (!options.buckets || *options.buckets == 0 || *options.buckets == first.info.buckets) return;
  throw Error(ErrorKind::kBadInput,
              "this fragment was made with --buckets " + std::to_string(first.info.buckets) + ", not with " +
                  std::to_string(*options.buckets),
              "leave out --buckets, or make the fragments again")
      .at(first.path);
}

// In the order of the mesh, so that neighbours are glued first.
void sort_parts(std::vector<NamedPart>& parts) {
  std::ranges::sort(parts, {}, [](const NamedPart& part) { return part.info.runs[0].first; });
}

void add_fragment(RunContext& run, const NamedPart& part, PartGlue& glue, Reservation& live) {
  FragmentFile file(part.path);
  if (const std::string why = difference(file.info(), part.info); !why.empty() || file.info().runs != part.info.runs)
    throw input_changed("this fragment changed while it was read").at(part.path);
  const Reservation reading = run.budget.reserve("fragment", file.open_bytes());
  OpenPart open = file.read_open();
  live.resize(std::max<std::uint64_t>(live.bytes(), glue.memory_bytes_with(open)));
  try {
    glue.add(open, part.info.runs);
  } catch (const Error& error) {
    if (error.cause() != ErrorCause::kChanged) throw;
    throw Error(ErrorKind::kBadInput, "this fragment has other values at the vertices that it shares",
                "make all fragments of the same mesh, and their parts again")
        .at(part.path);
  }
  live.resize(glue.memory_bytes());
  file.copy_settled(*run.stores[0], run.embeds());
}

GlueResult glue_in(RunContext& run, const std::vector<NamedPart>& parts, PartInfo united, bool as_fragment) {
  const Stopwatch watch;
  for (const std::string& output : run.outputs) io::remove_abandoned(output);
  const SweepOptions sweep = united.sweep();
  Reservation live = run.budget.reserve("live graph", 0);
  GlueResult glued;
  {
    PartGlue glue(*run.stores[0], united.mesh.shares.parts, sweep);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      run.tell({ComputeProgress::Phase::kReeb, i, parts.size()});
      run.resumable.check_interruption();
      add_fragment(run, parts[i], glue, live);
      united.live.vertices = std::max(united.live.vertices, std::uint64_t{glue.glue().live_vertices()});
      united.live.bytes = std::max(united.live.bytes, std::uint64_t{glue.memory_bytes()});
    }
    united.removed_pairs = glue.removed_pairs();
    glued.open_vertices = glue.glue().live_vertices();
    if (as_fragment) {
      OpenPart open;
      live.resize(live.bytes() + glue.copy_bytes());
      glue.copy_open(open);
      if (!sweep.bucket_exponent) open.live.bucket_begin.clear();
      SegmentStore& store = *run.stores[0];
      store.finish();
      united.settled_nodes = store.node_count();
      united.settled_arcs = store.arc_count();
      write_fragment(run.outputs[0], run.output_options(), united, open, store);
      glued.info = std::move(united);
      return glued;
    }
  }
  live.release();
  return_freed_memory();
  FirstStageResult first = first_stage_of(united);
  first.seconds.wall = first.seconds.reeb = watch.seconds();
  if (united.range.min <= united.range.max) run.values.set_ranges(std::span(&united.range, 1));
  glued.result = run_second_stage(run, first, 0);
  glued.info = std::move(united);
  return glued;
}

}  // namespace

ComputeOptions options_of_glue(const PartInfo& united, const GlueOptions& options) {
  ComputeOptions run;
  run.memory_bytes = options.memory_bytes;
  run.threads = options.threads;
  run.temp_dir = options.temp_dir;
  run.replace = options.replace;
  run.graph_only = options.graph_only || united.graph_only;
  run.buckets = united.buckets;
  run.denoise = united.denoise;
  run.denoise_is_share = united.denoise_is_share;
  run.progress = options.progress;
  run.interrupted = options.interrupted;
  return run;
}

FirstStageResult first_stage_of(const PartInfo& united) {
  FirstStageResult first;
  first.vertices = united.mesh.shares.vertices;
  first.vertex_bound = united.mesh.numbers;
  first.unused_vertices = united.unused_vertices;
  first.simplices = united.mesh.simplices;
  first.degenerate_triangles = listed_as_degenerate(united.degenerate_triangles, first.simplices);
  first.live = united.live;
  first.removed_pairs = {united.removed_pairs};
  return first;
}

GlueResult glue_fragments(std::span<const std::string> fragments, const std::string& output, bool as_fragment,
                          const GlueOptions& options) {
  if (fragments.empty()) throw Error(ErrorKind::kUsage, "there are no fragments to glue", "name at least one");
  io::require_output_folder(output);
  std::vector<NamedPart> parts = read_infos(fragments);
  check_buckets(parts[0], options);
  PartInfo united = united_info(parts);
  if (!as_fragment) require_all_parts(parts, united);
  sort_parts(parts);
  if (options.buckets == 0u) united.buckets = 0;
  const ComputeOptions run_options = options_of_glue(united, options);
  NamedFunction function(united.function);
  VertexFunction* const functions[] = {&function};
  MeshInput none;
  none.path = "-";
  RunContext run(none, functions, std::span(&output, 1), run_options);
  try {
    return glue_in(run, parts, std::move(united), as_fragment);
  } catch (const BrokenGraph& error) {
    // It is in what the fragments say has settled: only together it shows.
    throw Error(ErrorKind::kBadInput,
                std::string("the fragments are damaged, or do not belong together: ") + error.what(),
                "make the parts again with `reeb fragment`");
  } catch (...) {
    throw_explained(run);
  }
}

}  // namespace reeb::ooc
