// Fragments: what remains of shares of a mesh, and the nodes and arcs that settled in them, in a file of its own
// (docs/FORMAT.md, Fragments).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/parts/open_part.h"
#include "ooc/distributed/part_info.h"
#include "ooc/reeb_writer/frame_writer.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::ooc {

// Writes the fragment; it appears only when it is whole. REQUIRES: store.finish() was called.
// THROWS: as AtomicFile, and the store.
void write_fragment(const std::string& path, const OutputOptions& output, const PartInfo& info, const OpenPart& open,
                    SegmentStore& store);

// Whether the file begins like a fragment.
bool is_fragment(const std::string& path);

// A fragment to read. Nothing in it is trusted: every byte is under a checksum that is verified before it is used.
// THROWS, from every call: Error{kBadInput} that names the file if it is not a fragment, was cut off or is damaged.
class FragmentFile {
 public:
  explicit FragmentFile(const std::string& path);

  const std::string& path() const { return file_.path(); }
  std::uint64_t bytes() const { return file_.size(); }
  const PartInfo& info() const { return info_; }
  // The bytes that read_open() needs in memory, at most.
  std::uint64_t open_bytes() const { return state_bytes_; }
  OpenPart read_open();
  // Adds what settled to `store`, whose arcs get buckets if these are wanted. MEMORY: a block, packed and unpacked,
  // from the store's budget. That a node comes once, and that the ends of arcs are nodes, shows when the store is read.
  void copy_settled(SegmentStore& store, bool with_buckets);

 private:
  [[noreturn]] void fail(const std::string& why, std::uint64_t offset) const;
  struct Block {
    std::vector<std::byte> packed;
    std::uint64_t count = 0;  // of records
    Reservation memory;
  };
  void read_block(std::uint64_t kind, Block& block);
  void copy_nodes(SegmentStore& store);
  void copy_arcs(SegmentStore& store, bool with_buckets);
  void check_keys(const SweepKey& key) const;

  io::File file_;
  std::uint64_t state_begin_ = 0, state_bytes_ = 0, info_bytes_ = 0, at_ = 0;
  PartInfo info_;
};

}  // namespace reeb::ooc
