#include "ooc/threads/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <thread>

#include "ooc/threads/kept_arena.h"

namespace reeb::ooc {

void in_parallel(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  kept_arena(threads).execute([&] { tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { work(i); }); });
}

}  // namespace reeb::ooc
