// Allocations that fail on request. It replaces operator new of the program, so only one source file may include it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

#include "tests/support/allocation_pause.h"

namespace reeb::test {

inline std::atomic<std::uint64_t> allocations{0}, failing_allocation{0};

// During its lifetime allocations are counted from 1, in all threads, and number n fails. n = 0: none.
class ScopedAllocationFault {
 public:
  explicit ScopedAllocationFault(std::uint64_t n) {
    allocations = 0;
    failing_allocation = n;
  }
  ScopedAllocationFault(const ScopedAllocationFault&) = delete;
  ScopedAllocationFault& operator=(const ScopedAllocationFault&) = delete;
  ~ScopedAllocationFault() { failing_allocation = 0; }

  std::uint64_t count() const { return allocations; }
};

// `alignment` 0: the usual one.
inline void* allocate_or_fail(std::size_t size, std::size_t alignment) {
  const bool counts = !allocations_pass.load(std::memory_order_relaxed);
  const std::uint64_t number = counts ? allocations.fetch_add(1, std::memory_order_relaxed) + 1 : 0;
  if (counts && number == failing_allocation.load(std::memory_order_relaxed)) throw std::bad_alloc();
  void* const memory = alignment == 0 ? std::malloc(size == 0 ? 1 : size)
                                      : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace reeb::test

// Not inlined: GCC 12 takes the malloc inside for a mismatch of new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) { return reeb::test::allocate_or_fail(size, 0); }
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return reeb::test::allocate_or_fail(size, static_cast<std::size_t>(alignment));
}
// As std::stable_sort asks. A sanitizer's own would not match the operator delete below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { operator delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { operator delete(memory); }
