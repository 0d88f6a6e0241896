#include "tools/python/array_grid.h"

#include <algorithm>
#include <string>
#include <vector>

#include "io/mesh/property_columns.h"
#include "tools/python/strided_array.h"

namespace reeb::python {
namespace {

class Reader final : public GridReader {
 public:
  explicit Reader(const ArrayGrid& grid) : grid_(grid) {}

  const GridInfo& info() const override { return grid_.info; }

  // Row by row along i.
  std::size_t read(std::span<double> values) override {
    const std::uint64_t width = grid_.info.size[0];
    std::size_t filled = 0;
    while (filled < values.size() && next_ < grid_.info.vertex_count()) {
      const std::uint64_t i = next_ % width;
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(width - i, values.size() - filled));
      const char* item = at(next_);
      io::with_type(grid_.type, [&](auto zero) {
        for (std::size_t n = 0; n < count; ++n, item += grid_.stride[0]) {
          const auto value = io::load_scalar<decltype(zero)>(item, false);
          rounded_ += io::is_rounded(value) ? 1u : 0u;
          values[filled + n] = static_cast<double>(value) + 0.0;
        }
      });
      filled += count;
      next_ += count;
    }
    return filled;
  }
  void rewind() override { next_ = rounded_ = 0; }
  GridPlace place_of(std::uint64_t vertex) const override {
    const auto [i, j, k] = indices(vertex);
    std::string position = std::to_string(j) + ", " + std::to_string(i);
    if (grid_.info.axes == 3) position = std::to_string(k) + ", " + position;
    return {kNoFile, place_in("image", position)};
  }
  std::uint64_t bytes_read() const override { return next_ * io::byte_size(grid_.type); }
  std::vector<std::string> warnings() const override {
    if (rounded_ == 0) return {};
    return {io::note_on_rounded_values(rounded_)};
  }

 private:
  std::array<std::uint64_t, 3> indices(std::uint64_t vertex) const {
    const auto& size = grid_.info.size;
    return {vertex % size[0], vertex / size[0] % size[1], vertex / size[0] / size[1]};
  }
  const char* at(std::uint64_t vertex) const {
    const auto index = indices(vertex);
    const char* place = grid_.data;
    for (std::size_t axis = 0; axis < 3; ++axis) place += static_cast<std::int64_t>(index[axis]) * grid_.stride[axis];
    return place;
  }

  ArrayGrid grid_;
  std::uint64_t next_ = 0;
  std::uint64_t rounded_ = 0;  // values before next_
};

}  // namespace

std::unique_ptr<GridReader> read_grid(const ArrayGrid& grid) { return std::make_unique<Reader>(grid); }

}  // namespace reeb::python
