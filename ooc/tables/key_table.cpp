#include "ooc/tables/key_table.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kBufferKeys = 4096;

}  // namespace

KeyTable::KeyTable(std::string folder) : folder_(std::move(folder)) {
  std::string name = folder_ + "/.reeb-keys-XXXXXX";
  fd_ = ::mkstemp(name.data());
  if (fd_ < 0) fail("a scratch file cannot be made");
  ::unlink(name.c_str());
  buffer_.reserve(kBufferKeys);
}

KeyTable::~KeyTable() {
  if (keys_ != nullptr) ::munmap(const_cast<SweepKey*>(keys_), count_ * sizeof(SweepKey));
  if (fd_ >= 0) ::close(fd_);
}

void KeyTable::append(const SweepKey& key) {
  buffer_.push_back(key);
  if (buffer_.size() == kBufferKeys) flush();
}

void KeyTable::flush() {
  auto bytes = std::as_bytes(std::span(buffer_));
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("a scratch file cannot be written");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  count_ += buffer_.size();
  buffer_.clear();
}

void KeyTable::seal() {
  flush();
  if (count_ == 0) return;
  void* mapping = ::mmap(nullptr, count_ * sizeof(SweepKey), PROT_READ, MAP_SHARED, fd_, 0);
  if (mapping == MAP_FAILED) fail("a scratch file cannot be mapped");
  ::madvise(mapping, count_ * sizeof(SweepKey), MADV_RANDOM);  // no pages around the one needed
  keys_ = static_cast<const SweepKey*>(mapping);
}

std::uint64_t KeyTable::rank(const SweepKey& key, std::uint64_t from) const {
  // Doubling steps first: upper ends lie near lower ends more often than not.
  std::uint64_t step = 1;
  while (from + step < count_ && keys_[from + step] < key) {
    from += step;
    step *= 2;
  }
  const std::uint64_t last = std::min(count_, from + step + 1);
  const SweepKey* const found = std::lower_bound(keys_ + from, keys_ + std::max(from, last), key);
  if (found == keys_ + count_ || !(*found == key))
    throw std::logic_error("KeyTable: no node is vertex " + std::to_string(key.vertex.value()));
  return static_cast<std::uint64_t>(found - keys_);
}

void KeyTable::release_pages() const {
  if (keys_ != nullptr) ::madvise(const_cast<SweepKey*>(keys_), count_ * sizeof(SweepKey), MADV_DONTNEED);
}

void KeyTable::fail(const char* action) const {
  throw Error(ErrorKind::kResource, std::string(action) + ": " + std::strerror(errno),
              "make room there, or write to another folder")
      .at(folder_);
}

}  // namespace reeb::ooc
