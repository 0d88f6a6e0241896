#include "io/file/temporary_name.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace reeb::io {
namespace {

// Copies of the names, which a handler can read at any moment. A run has few names at a time. The file of a name that
// finds no place here stays if a signal ends the process, and the next writer of that output removes it.
std::array<std::atomic<char*>, 64> table{};
static_assert(std::atomic<char*>::is_always_lock_free, "a signal handler may not wait");

}  // namespace

TemporaryName::TemporaryName(std::string path) : path_(std::move(path)) {
  char* const copy = ::strdup(path_.c_str());
  for (std::size_t i = 0; copy != nullptr && i < table.size(); ++i) {
    char* none = nullptr;
    if (!table[i].compare_exchange_strong(none, copy)) continue;
    slot_ = i;
    return;
  }
  std::free(copy);
}

TemporaryName::TemporaryName(TemporaryName&& other) noexcept
    : path_(std::exchange(other.path_, {})), slot_(std::exchange(other.slot_, kNoSlot)) {}

TemporaryName& TemporaryName::operator=(TemporaryName&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(slot_, other.slot_);
  return *this;
}

TemporaryName::~TemporaryName() {
  if (!path_.empty()) ::unlink(path_.c_str());
  release();
}

void TemporaryName::release() noexcept {
  path_.clear();
  if (slot_ != kNoSlot) std::free(table[std::exchange(slot_, kNoSlot)].exchange(nullptr));
}

void remove_temporary_names() noexcept {
  for (std::atomic<char*>& entry : table)
    // Whoever takes the copy owns it: a thread that frees its name at this moment finds nothing.
    if (const char* name = entry.exchange(nullptr)) ::unlink(name);
}

}  // namespace reeb::io
