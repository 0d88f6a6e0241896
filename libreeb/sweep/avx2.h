// Whether the processor has AVX2, for the two loops over the vertices of a chunk that are written with its
// instructions.
#pragma once

namespace reeb {

inline bool has_avx2() noexcept {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0;
#else
  return false;
#endif
}

}  // namespace reeb
