#include "tools/program/process_memory.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>  // says which library it is
#include <new>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#endif

namespace reeb::tools {

void set_up_process_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);
  mallopt(M_TRIM_THRESHOLD, 256 * 1024);
  mallopt(M_ARENA_MAX, 2);
#endif
}

}  // namespace reeb::tools

// Sanitizers have their own.
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;
// The least that has a whole huge page wherever it begins.
constexpr std::size_t kLargeBlock = 2 * kHugePage;

void ask_for_huge_pages(void* block, std::size_t size) {
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t begin = (address + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t end = (address + size) / kHugePage * kHugePage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // or all stays as it is
}

}  // namespace

void* operator new(std::size_t size) {
  while (true) {
    if (void* block = std::malloc(size)) {
      if (size >= kLargeBlock) ask_for_huge_pages(block, size);
      return block;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

#endif
