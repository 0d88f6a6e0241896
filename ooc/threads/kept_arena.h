// Arenas of threads that are kept for the next run.
//
// TBB gives an arena back long after it was destroyed, and searches all of them for work meanwhile: a
// process that makes thousands of short runs would become slower with each.
#pragma once

#include <tbb/task_arena.h>

namespace reeb::ooc {

// The arena of this process with so many threads, the caller among them. Any thread may use it.
tbb::task_arena& kept_arena(unsigned threads);

}  // namespace reeb::ooc
