#include "tools/library/run_options.h"

#include <cmath>
#include <memory>
#include <mutex>
#include <string>

#include "libreeb/base/error.h"

namespace reeb {

void check_limits(const ComputeOptions& options) {
  if (!(options.denoise >= 0) || !std::isfinite(options.denoise))
    throw Error(ErrorKind::kUsage, "denoise is not a finite number of 0 or more", "give a threshold like 0.001");
  if (options.buckets > kMostBuckets)
    throw Error(ErrorKind::kUsage, "there can be at most " + std::to_string(kMostBuckets) + " buckets",
                "choose fewer, for instance 64");
  if (options.threads > kMostThreads)
    throw Error(ErrorKind::kUsage, "there can be at most " + std::to_string(kMostThreads) + " threads",
                "choose fewer, or 0 for those of the machine");
  if (!(options.checkpoint_seconds >= 0))
    throw Error(ErrorKind::kUsage, "the seconds between checkpoints are not a number of 0 or more", "choose 2");
}

ooc::ComputeOptions run_options(const ComputeOptions& options) {
  ooc::ComputeOptions run;
  run.memory_bytes = options.memory_bytes;
  run.threads = options.threads;
  run.chunk_triangles = options.chunk_triangles;
  run.temp_dir = options.temp_dir;
  run.replace = options.replace;
  run.graph_only = options.graph_only;
  run.keep_sidecar = options.keep_sidecar;
  run.may_reorder = options.may_reorder;
  run.buckets = options.buckets;
  run.manifold = options.manifold;
  run.denoise = options.denoise;
  run.denoise_is_share = options.denoise_is_share;
  run.resume = options.resume;
  run.checkpoint_seconds = options.checkpoint_seconds;
  // The stages of a run are in several threads.
  const auto one_at_a_time = std::make_shared<std::mutex>();
  if (options.progress)
    run.progress = [one_at_a_time, tell = options.progress](const ComputeProgress& progress) {
      const std::lock_guard lock(*one_at_a_time);
      tell(progress);
    };
  if (options.interrupted)
    run.interrupted = [one_at_a_time, ask = options.interrupted] {
      const std::lock_guard lock(*one_at_a_time);
      return ask();
    };
  return run;
}

}  // namespace reeb
