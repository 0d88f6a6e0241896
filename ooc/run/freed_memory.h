// Between two stages.
#pragma once

#include <cstdlib>  // says which library it is

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace reeb::ooc {

// What a stage has freed lies in small pieces. The next one, with pieces of other sizes, would be piled on top
// of them.
inline void give_back_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace reeb::ooc
