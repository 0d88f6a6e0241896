// The bytes of an array, unpacked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/vtk/encoded_bytes.h"
#include "io/vtk/number_place.h"

namespace reeb::io {

// MEMORY: a block of the file, packed and unpacked, which is 32 KB as VTK writes it; and the sizes of the blocks.
class ArrayBytes {
 public:
  // THROWS: Error{kBadInput} if the header of the array is damaged.
  ArrayBytes(std::unique_ptr<ContentSource> source, const NumberPlace& place);

  // Reads at most `limit` bytes and returns their number; 0 only at the end.
  // THROWS: Error{kBadInput} where the array is damaged or cut.
  std::size_t read(char* out, std::size_t limit);

  // The number of all bytes, if the file says it.
  std::optional<std::uint64_t> size() const { return size_; }
  std::uint64_t offset() const { return bytes_.offset(); }
  const ContentSource& source() const { return bytes_.source(); }
  std::uint64_t bytes_read() const { return bytes_.bytes_read(); }
  std::uint64_t memory_bytes() const { return 8 * packed_sizes_.capacity() + packed_.capacity() + block_.capacity(); }

 private:
  std::uint64_t header_number();
  void read_block_sizes();
  void unpack_block();
  void read_packed(std::uint64_t size);
  [[noreturn]] void fail(const std::string& what) const;

  EncodedBytes bytes_;
  NumberPlace place_;
  std::optional<std::uint64_t> size_;
  std::uint64_t left_ = 0;  // without packing: bytes that were not read

  std::vector<std::uint64_t> packed_sizes_;
  std::uint64_t block_bytes_ = 0, last_block_bytes_ = 0;
  std::size_t next_block_ = 0;
  std::vector<char> packed_, block_;
  std::size_t taken_ = 0;  // of block_
};

}  // namespace reeb::io
