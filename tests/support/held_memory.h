// The memory that a program holds through operator new, as rounded by the allocator. It replaces the operators, so only
// one source file of a program may include it.
#pragma once

#include <malloc.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace reeb::test {

inline std::atomic<std::size_t> held_bytes{0}, peak_bytes{0};

// Runs `work` once, untimed. Returns the most memory that was held meanwhile, minus what was held before.
template <class Work>
std::size_t peak_of(Work work) {
  const std::size_t before = held_bytes;
  peak_bytes = before;
  work();
  return peak_bytes - before;
}

}  // namespace reeb::test

// Not inlined: GCC 12 takes the malloc inside for a mismatch of new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t held = reeb::test::held_bytes += malloc_usable_size(memory);
  if (held > reeb::test::peak_bytes) reeb::test::peak_bytes = held;
  return memory;
}
// As std::stable_sort asks. A sanitizer's own would not match the operator delete below.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  if (memory != nullptr) reeb::test::held_bytes -= malloc_usable_size(memory);
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
