// Arenas of threads that are kept from run to run.
//
// TBB frees an arena long after it was destroyed, and until then searches all arenas for work: a process that makes
// thousands of short runs would become slower with each run.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace reeb::ooc {

// The arena of this process with this number of threads, including the caller. Any thread may use it.
tbb::task_arena& kept_arena(unsigned threads);

// Calls work() in that arena.
//
// Without the limit TBB would use at most as many threads as the machine has processors, even if a user asks for more.
// The limit applies to the whole process: while this runs, other TBB work of the process has no more threads than this,
// either. Nothing else in the library sets a limit.
template <class Work>
void run_in_kept_arena(unsigned threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  kept_arena(threads).execute(work);
}

}  // namespace reeb::ooc
