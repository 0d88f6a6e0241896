// Lets allocations pass, although they would fail on request (allocation_faults.h).
#pragma once

#include <atomic>

namespace reeb::test {

inline std::atomic<bool> allocations_pass{false};

}  // namespace reeb::test
