// The rank of a node in a sorted list of nodes that need not fit in memory.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "libreeb/base/sweep_key.h"

namespace reeb::ooc {

// Keys are appended to a nameless scratch file and then searched through a mapping of it, which is
// given back after each batch: memory is one buffer, whatever the number of keys.
// THROWS: Error{kResource} with the folder.
class KeyTable {
 public:
  explicit KeyTable(std::string folder);
  KeyTable(const KeyTable&) = delete;
  KeyTable& operator=(const KeyTable&) = delete;
  ~KeyTable();

  // REQUIRES: ascending; no rank was asked for yet.
  void append(const SweepKey& key);
  // Ends appending.
  void seal();

  // Rank of `key`; it is not below the rank `from`, and the nearer the faster.
  // THROWS: std::logic_error if it is not there.
  std::uint64_t rank(const SweepKey& key, std::uint64_t from) const;
  // Gives the pages that were looked at back to the system.
  void release_pages() const;

 private:
  void flush();
  [[noreturn]] void fail(const char* action) const;

  std::string folder_;
  int fd_ = -1;
  std::uint64_t count_ = 0;
  std::vector<SweepKey> buffer_;
  const SweepKey* keys_ = nullptr;
};

}  // namespace reeb::ooc
