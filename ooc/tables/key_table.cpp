#include "ooc/tables/key_table.h"

#include <algorithm>
#include <string>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::ooc {
namespace {

constexpr std::size_t kBufferKeys = 4096;

}  // namespace

KeyTable::KeyTable(const io::TempDir& temp) : file_(temp.create_unnamed("keys of nodes")) {
  buffer_.reserve(kBufferKeys);
}

void KeyTable::append(const SweepKey& key) {
  buffer_.push_back(key);
  if (buffer_.size() == kBufferKeys) flush();
}

void KeyTable::flush() {
  file_.write_at(count_ * sizeof(SweepKey), std::as_bytes(std::span(buffer_)));
  count_ += buffer_.size();
  buffer_.clear();
}

void KeyTable::seal() {
  flush();
  if (count_ == 0) return;
  mapping_ = file_.map(0, static_cast<std::size_t>(count_ * sizeof(SweepKey)));
  mapping_.expect_random_access();
  keys_ = reinterpret_cast<const SweepKey*>(mapping_.bytes().data());
}

std::uint64_t KeyTable::rank(const SweepKey& key, std::uint64_t from) const {
  // Doubling steps first, since most upper ends are near lower ends.
  std::uint64_t step = 1;
  while (from + step < count_ && keys_[from + step] < key) {
    from += step;
    step *= 2;
  }
  const std::uint64_t last = std::min(count_, from + step + 1);
  const SweepKey* const found = std::lower_bound(keys_ + from, keys_ + std::max(from, last), key);
  if (found == keys_ + count_ || !(*found == key))
    throw BrokenGraph("KeyTable: no node is vertex " + std::to_string(key.vertex.value()));
  return static_cast<std::uint64_t>(found - keys_);
}

}  // namespace reeb::ooc
