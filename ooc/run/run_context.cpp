#include "ooc/run/run_context.h"

#include "libreeb/graph/bucket.h"
#include "ooc/threads/machine_threads.h"

namespace reeb::ooc {
namespace {

unsigned threads_for(const MeshInput& input, const ComputeOptions& options) {
  if (options.threads != 0) return options.threads;
  return input.size == MeshSize::kAny ? machine_threads() : 1;
}

MemoryRequest memory_request(const MeshInput& input, unsigned threads, std::size_t functions,
                             const ComputeOptions& options) {
  return {.limit_bytes = options.memory_bytes,
          .threads = threads,
          .functions = functions,
          .chunk_triangles = options.chunk_triangles,
          .stretch_triangles = options.stretch_triangles,
          .reader_bytes = input.reader_bytes,
          .in_place = input.indexed != nullptr,
          .embeds = options.buckets != 0,
          .denoises = options.denoise > 0};
}

// The path of a mesh that a later process can read in the same way.
std::string readable_again(const MeshInput& input) { return input.may_resume && input.path != "-" ? input.path : ""; }

}  // namespace

SweepOptions sweep_options(const ComputeOptions& options, const ValueRange& range) {
  SweepOptions sweep;
  sweep.noise_below = options.denoise_is_share ? range.part(options.denoise) : options.denoise;
  if (options.buckets != 0) sweep.bucket_exponent = bucket_exponent(range.min, range.max, options.buckets);
  sweep.manifold = options.manifold;
  return sweep;
}

RunContext::RunContext(const MeshInput& input, std::span<VertexFunction* const> run_functions,
                       std::span<const std::string> run_outputs, const ComputeOptions& run_options)
    : functions(run_functions),
      outputs(run_outputs),
      options(run_options),
      size(input.size),
      threads(threads_for(input, options)),
      plan(plan_memory(memory_request(input, threads, functions.size(), options))),
      budget(plan.budget_bytes, plan.set_aside_bytes),
      temp(options.temp_dir.empty() ? io::TempDir::default_folder(outputs[0]) : options.temp_dir),
      values(functions, input.dimension),
      resumable(outputs[0], readable_again(input), functions,
                {options.denoise, options.denoise_is_share, options.buckets, input.reading, options.manifold},
                {options.resume, options.replace, options.checkpoint_seconds, options.interrupted}),
      check_mesh_(input.check_unchanged) {
  make_stores();
}

void RunContext::make_stores() {
  stores.clear();
  for (std::size_t f = 0; f < functions.size(); ++f)
    stores.push_back(
        std::make_unique<SegmentStore>(temp, budget,
                                       SegmentOptions{.allowance_bytes = plan.segment_bytes,
                                                      .most_bytes = plan.most_segment_bytes,
                                                      .background = background(),
                                                      .files = resumable.segments_of(f),
                                                      .poll = [this] { resumable.check_interruption(); }}));
}

void RunContext::start_over() {
  make_stores();
  if (follower) follower->start_over();
  resumable.start_over();
  values.set_ranges(std::vector<ValueRange>(functions.size()));
}

void RunContext::restore_stores(StateReader& in) {
  try {
    for (const auto& store : stores) store->restore(in);
  } catch (...) {
    make_stores();
    throw;
  }
}

void RunContext::check_inputs() const {
  if (check_mesh_) check_mesh_();
  for (const VertexFunction* function : functions) function->check_unchanged();
}

void RunContext::tell(const ComputeProgress& progress) const {
  if (options.progress) options.progress(progress);
  if (progress.phase != ComputeProgress::Phase::kReeb) resumable.check_interruption();
}

}  // namespace reeb::ooc
