// Limits under which the tests of whole runs are run a second time: the least memory, and tiny chunks.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>

namespace reeb::test {

inline std::optional<std::uint64_t> number_in_environment(const char* name) {
  const char* text = std::getenv(name);
  if (text == nullptr) return std::nullopt;
  return std::strtoull(text, nullptr, 10);
}

// Bytes; none: no limit.
inline std::optional<std::uint64_t> memory_limit() { return number_in_environment("REEB_TEST_MEMORY"); }
// Triangles per chunk; none: the test chooses.
inline std::optional<std::uint64_t> chunk_limit() { return number_in_environment("REEB_TEST_CHUNK"); }

}  // namespace reeb::test
