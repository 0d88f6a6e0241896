// The rank of a node in a sorted list of nodes that need not fit in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/sweep_key.h"

namespace reeb::ooc {

// Keys are appended to a temporary file and then searched through a mapping of it, whose pages can be released after
// each batch. So the memory is one buffer, whatever the number of keys.
// THROWS: Error{kResource} if the disk is full.
class KeyTable {
 public:
  explicit KeyTable(const io::TempDir& temp);

  // REQUIRES: ascending; rank() was not called yet.
  void append(const SweepKey& key);
  // Ends appending.
  void seal();

  // The rank of `key`. Faster if it is near `from`. REQUIRES: the rank is not below `from`.
  // THROWS: BrokenGraph if the key is not in the table.
  std::uint64_t rank(const SweepKey& key, std::uint64_t from) const;
  // Returns the pages that were read to the system.
  void release_pages() const { mapping_.release_pages(); }

  std::uint64_t spilled_bytes() const { return count_ * sizeof(SweepKey); }

 private:
  void flush();

  io::File file_;
  std::uint64_t count_ = 0;
  std::vector<SweepKey> buffer_;
  io::Mapping mapping_;
  const SweepKey* keys_ = nullptr;
};

}  // namespace reeb::ooc
