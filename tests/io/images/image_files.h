// For the tests of images: files written by hand, and grids as the readers deliver them.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "io/file/zstd_codec.h"
#include "io/formats/open_grid.h"
#include "libreeb/base/error.h"
#include "tests/io/formats/mesh_files.h"

namespace reeb::io::testing {

// Everything that a reader delivers.
struct Grid {
  GridInfo info;
  std::vector<double> values;
};

// Reads in steps of `step` vertices, twice, which must agree.
inline Grid read_grid(GridReader& reader, std::size_t step = 7) {
  Grid grid{reader.info(), {}};
  for (const bool again : {false, true}) {
    std::vector<double> all, part(step * grid.info.components);
    while (const std::size_t count = reader.read(part)) {
      EXPECT_LE(count, step);
      const auto values = std::span(part).first(count * grid.info.components);
      all.insert(all.end(), values.begin(), values.end());
    }
    EXPECT_EQ(all.size(), grid.info.vertex_count() * grid.info.components);
    if (again) {
      for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint64_t>(all[i]), std::bit_cast<std::uint64_t>(grid.values.at(i))) << i;
    } else {
      grid.values = std::move(all);
      reader.rewind();
    }
  }
  return grid;
}

inline Grid read_grid(const std::string& path, const GridOptions& options = {}) {
  return read_grid(*open_grid(path, options));
}

inline std::string error_of(const std::string& path, const GridOptions& options = {}) {
  try {
    const auto reader = open_grid(path, options);
    std::vector<double> values(100 * reader->info().components);
    while (reader->read(values) != 0) {
    }
  } catch (const Error& error) {
    EXPECT_FALSE(error.hint().empty());
    const std::string folder = scratch_folder().string() + "/";
    std::string text = error.what();
    if (const std::size_t at = text.find(folder); at != std::string::npos) text.erase(at, folder.size());
    return text;
  }
  return {};
}

// The numbers as text, in binary, and packed.
template <class T>
std::string binary(const std::vector<T>& values, bool big_endian = false) {
  std::string bytes;
  for (const T value : values) bytes += scalar_bytes(value, big_endian);
  return bytes;
}

// window_bits: 15 for zlib, 31 for gzip.
inline std::string deflated(const std::string& bytes, int window_bits) {
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window_bits, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}
inline std::string zlib_packed(const std::string& bytes) { return deflated(bytes, 15); }
inline std::string gzip_packed(const std::string& bytes) { return deflated(bytes, 31); }
inline std::string zstd_packed(const std::string& bytes) {
  std::vector<std::byte> packed;
  zstd_compress(std::as_bytes(std::span(bytes)), 3, packed);
  return {reinterpret_cast<const char*>(packed.data()), packed.size()};
}

}  // namespace reeb::io::testing
