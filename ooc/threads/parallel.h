// Independent pieces of work, in several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace reeb::ooc {

// Calls work(i) for every i below `count`, in no order, by `threads` threads (0: all), in their kept arena.
// THROWS: what a call throws.
void in_parallel(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace reeb::ooc
