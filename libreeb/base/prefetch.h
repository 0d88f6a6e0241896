// Brings memory to the cache before it is needed.
#pragma once

namespace reeb {

// Prefetches the cache line of `address`. GCC takes a function that only prefetches for one without effect, and removes
// the calls to it. The empty statement prevents that.
inline void prefetch(const void* address) {
  __builtin_prefetch(address);
  asm volatile("" ::);
}

// The same for memory that is about to be written to, which another core may have in its cache.
inline void prefetch_to_write(void* address) {
  __builtin_prefetch(address, 1);
  asm volatile("" ::);
}

}  // namespace reeb
