// Returns freed memory to the system between two stages.
#pragma once

#include <cstdlib>  // says which library it is

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace reeb::ooc {

// A stage frees many small blocks. The next stage needs blocks of other sizes, which would take new memory in addition.
inline void return_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace reeb::ooc
