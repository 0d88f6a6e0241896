// One number per vertex, from a file: lines of text, raw little-endian float64 (".f64"), or an array of NumPy (".npy").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/file/input_file.h"

namespace reeb::io {

class ValueFile {
 public:
  ValueFile() = default;
  ValueFile(const ValueFile&) = delete;
  ValueFile& operator=(const ValueFile&) = delete;
  virtual ~ValueFile() = default;

  // The values of vertices 0, 1, 2, ... in turn.
  virtual double next() = 0;
  // next() continues with this vertex. Values that are passed are not looked at. REQUIRES: it is not before the next
  // one.
  virtual void skip_to(std::uint64_t vertex) = 0;
  virtual double at(std::uint64_t vertex) = 0;
  virtual void check_count(std::uint64_t vertex_count) = 0;
  virtual void check_unchanged() const = 0;
  // Memory that at() takes, for this number of vertices.
  virtual std::uint64_t lookup_bytes(std::uint64_t) const { return 0; }
};

// `has_gaps`: some vertices are left out, and their values need not be finite.
// THROWS: Error{kBadInput} if the file cannot be read, or is known not to have one value per vertex.
std::unique_ptr<ValueFile> open_values(const std::string& path, std::optional<std::uint64_t> vertex_count,
                                       bool has_gaps);

// Raw float64 values in an open file.
std::unique_ptr<ValueFile> raw_values(std::shared_ptr<const InputFile> file);

}  // namespace reeb::io
