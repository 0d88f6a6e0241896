// Port: a regular grid of values in a file of any format, read in the order of the file.
//
// Vertex (i, j, k) has the index i + size[0] * (j + size[1] * k), with i along the axis that varies fastest in the
// file. A value can be NaN or infinite: who uses the grid decides what that means.
//
// MEMORY: a reader holds windows of its input, never the file, whatever the header announces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace reeb {

struct GridInfo {
  std::string format;                          // "NRRD gzip", "NIfTI-1", "raw u16le"
  unsigned axes = 3;                           // 2 or 3: how many coordinates a vertex has
  std::array<std::uint64_t, 3> size{1, 1, 1};  // vertices along i, j and k, none of them 0; size[2] is 1 if axes is 2
  // Vertex (i, j, k) is at origin + i * step[0] + j * step[1] + k * step[2]; all are finite.
  std::array<double, 3> origin{};
  std::array<std::array<double, 3>, 3> step{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  bool has_spacing = true;       // the file says the steps, or their lengths
  std::string value_type;        // "u8", "f32", ...; empty: not known
  unsigned components = 1;       // values of a vertex
  std::optional<double> nodata;  // as the header declares it: the value of a vertex that has none
  std::uint64_t file_bytes = 0;  // of the data, as stored; 0: unknown (a pipe)

  // At most 2^56, and so are the values of all vertices.
  std::uint64_t vertex_count() const { return size[0] * size[1] * size[2]; }
  // A coordinate of vertex (i, j, k).
  double coordinate(std::size_t axis, const std::array<std::uint64_t, 3>& at) const {
    double sum = origin[axis];
    for (std::size_t k = 0; k < axes; ++k) sum += static_cast<double>(at[k]) * step[k][axis];
    return sum + 0.0;  // -0.0 becomes 0.0
  }
};

// A place in a file, as messages name it. An empty position means that only the file is known.
struct GridPlace {
  std::string file, position;
};

// THREADS: one at a time; different readers share nothing.
// TIME:    that of reading and parsing the input once.
class GridReader {
 public:
  GridReader() = default;
  GridReader(const GridReader&) = delete;
  GridReader& operator=(const GridReader&) = delete;
  virtual ~GridReader() = default;

  // Known as soon as the reader exists.
  virtual const GridInfo& info() const = 0;

  // Fills `values` with those of the next vertices, the components of a vertex next to each other, and returns the
  // number of these vertices. It is less than there is room for only at the end of the grid, and 0 from then on.
  // REQUIRES: values.size() is a multiple of info().components.
  // THROWS: Error{kBadInput} with file and position if the file ends before, or is damaged.
  virtual std::size_t read(std::span<double> values) = 0;

  // The next read() starts at the first vertex.
  // THROWS: Error{kBadInput} if the input can be read only once (a pipe) and part of it has been read.
  virtual void rewind() = 0;

  // Where the values of a vertex are in the file. Can read the file up to there once more.
  virtual GridPlace place_of(std::uint64_t vertex) const = 0;

  // How much of the input was read so far, in bytes of the file as stored on disk.
  virtual std::uint64_t bytes_read() const = 0;
  // The memory that it holds beyond windows.
  virtual std::uint64_t memory_bytes() const { return 0; }
  // Harmless oddities of the input, one line each. Complete at the end of the grid.
  virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace reeb
