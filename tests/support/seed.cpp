#include "tests/support/seed.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>

namespace reeb::test {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace

std::uint64_t base_seed() {
  const std::uint64_t seed = from_environment("REEB_SEED", 20070805);
  std::cout << "REEB_SEED=" << seed << '\n';
  return seed;
}

std::uint64_t case_count(std::uint64_t ordinary) {
  return std::min(from_environment("REEB_CASES", ordinary), from_environment("REEB_MOST_CASES", UINT64_MAX));
}

}  // namespace reeb::test
