#include "ooc/threads/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "ooc/threads/kept_arena.h"
#include "ooc/threads/machine_threads.h"
#include "ooc/threads/pipeline_order.h"

namespace reeb::ooc {

void in_parallel(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = machine_threads();
  if (threads == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  const PipelineOrder order;
  const auto body = [&](std::size_t i) {
    PipelineOrder::begin_filter();
    const char own = 0;
    const PipelineOrder::Filter filter(order, &own);
    work(i);
  };
  run_in_kept_arena(threads, [&] {
    PipelineOrder::filters_are_made();
    // A thread that waits here must not begin other work, which can take longer.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, body); });
  });
}

}  // namespace reeb::ooc
