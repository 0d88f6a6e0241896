// Arenas of threads that are kept for the next run.
//
// TBB gives an arena back long after it was destroyed, and searches all of them for work meanwhile: a
// process that makes thousands of short runs would become slower with each.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace reeb::ooc {

// The arena of this process with this number of threads, the caller among them. Any thread may use it.
tbb::task_arena& kept_arena(unsigned threads);

// Calls work() in that arena.
//
// Without the limit TBB would have no more threads than the machine has processors, however many a user
// asks for; and the limit exists for the process only. So while this runs, TBB work that the process
// does elsewhere has no more threads than this, either. Nothing else in the library sets a limit.
template <class Work>
void run_in_kept_arena(unsigned threads, const Work& work) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  kept_arena(threads).execute(work);
}

}  // namespace reeb::ooc
