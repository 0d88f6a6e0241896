// The values of an image as numbers, from binary data or from text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "io/decoding/byte_input.h"
#include "io/mesh/scalar_bytes.h"

namespace reeb::io {

class ValueStream {
 public:
  ValueStream() = default;
  ValueStream(const ValueStream&) = delete;
  ValueStream& operator=(const ValueStream&) = delete;
  virtual ~ValueStream() = default;

  // Fills `values` and returns how many there were: fewer only at the end of the data.
  // THROWS: Error{kBadInput} where the data are damaged.
  virtual std::size_t read(std::span<double> values) = 0;
  // Whether nothing follows but, in text, blanks.
  virtual bool at_end() = 0;
  // The place of the value read last, or of the end: a byte offset, or line:column.
  virtual std::string position() const = 0;
  // How many values were integers that no double is equal to.
  virtual std::uint64_t rounded() const { return 0; }
  virtual const ByteInput& bytes() const = 0;
};

std::unique_ptr<ValueStream> binary_values(std::unique_ptr<ByteInput> bytes, ScalarType type, bool big_endian);

// Numbers between white space, or also commas, as NRRD allows. The line and the column, from 1, are those of the first
// byte.
std::unique_ptr<ValueStream> text_values(std::unique_ptr<ByteInput> text, std::uint64_t line, std::uint64_t column,
                                         bool commas);

}  // namespace reeb::io
