// The base seed and the number of cases of a randomized test, from the environment.
#pragma once

#include <cstdint>

namespace reeb::test {

// REEB_SEED, else a fixed one; printed, so that a failure can be repeated.
std::uint64_t base_seed();

// REEB_CASES, else what the test runs ordinarily.
std::uint64_t case_count(std::uint64_t ordinary);

}  // namespace reeb::test
