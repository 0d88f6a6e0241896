// How many threads the machine runs at a time.
#pragma once

#include <algorithm>
#include <thread>

namespace reeb::ooc {

// 1 if that is not known.
inline unsigned machine_threads() { return std::max(1u, std::thread::hardware_concurrency()); }

}  // namespace reeb::ooc
