// Faults on request: tests let any call of this layer to the system fail, be short, or be interrupted.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>

namespace reeb::io {

enum class FileCall { kOpen, kRead, kWrite, kMap, kSync, kRename };

struct FileFault {
  int error = 0;                                                     // an errno: the call is not made and fails with it
  std::size_t most_bytes = std::numeric_limits<std::size_t>::max();  // a read or write moves no more than these
};

// Asked before each call. THREADS: any thread may ask, also several at once.
using FileFaultHook = std::function<FileFault(FileCall)>;

namespace detail {
inline std::atomic<const FileFaultHook*> fault_hook{nullptr};
}

// The fault for a call. Without a hook it costs a load and a branch that is never taken.
inline FileFault fault_for(FileCall call) {
  const FileFaultHook* const hook = detail::fault_hook.load(std::memory_order_acquire);
  if (hook == nullptr) [[likely]]
    return {};
  return (*hook)(call);
}

// Sets the hook of the process for as long as it lives; one at a time.
class ScopedFileFaults {
 public:
  explicit ScopedFileFaults(FileFaultHook hook) : hook_(std::move(hook)) { detail::fault_hook.store(&hook_); }
  ScopedFileFaults(const ScopedFileFaults&) = delete;
  ScopedFileFaults& operator=(const ScopedFileFaults&) = delete;
  ~ScopedFileFaults() { detail::fault_hook.store(nullptr); }

 private:
  FileFaultHook hook_;
};

}  // namespace reeb::io
