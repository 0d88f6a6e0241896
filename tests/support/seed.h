// The base seed and the number of cases of a randomized test, from the environment.
#pragma once

#include <cstdint>

namespace reeb::test {

// REEB_SEED, or a fixed seed. It is printed, so that a failure can be repeated.
std::uint64_t base_seed();

// REEB_CASES, or the usual number for the test; at most REEB_MOST_CASES.
std::uint64_t case_count(std::uint64_t ordinary);

}  // namespace reeb::test
