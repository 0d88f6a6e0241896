#include "libreeb/sweep/vertex_ranks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libreeb/sweep/chunk.h"

namespace reeb {
namespace {

// Numbers buckets of equal width from the least value to the greatest. Rounding is monotone in every step, so a greater
// value is never in a lower bucket.
class Buckets {
 public:
  Buckets(std::span<const double> values, std::size_t count) : last_(static_cast<double>(count - 1)) {
    double least = values.front(), greatest = least;
    for (const double value : values) {
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    least_ = least / 2;  // halved, so that no difference overflows
    const double scale = last_ / (greatest / 2 - least_);
    scale_ = std::isfinite(scale) ? scale : 0;
  }
  std::size_t operator()(double value) const {
    return static_cast<std::size_t>(std::min((value / 2 - least_) * scale_, last_));
  }

 private:
  double last_, least_, scale_;
};

template <class Iterator, class Before>
void sort_bucket(Iterator first, Iterator last, const Before& before) {
  constexpr std::ptrdiff_t kInsertionSortsUpTo = 8;
  if (last - first > kInsertionSortsUpTo) {
    std::sort(first, last, before);
    return;
  }
  for (auto end = first + 1; end != last; ++end) {
    const auto vertex = *end;
    auto to = end;
    for (; to != first && before(vertex, *(to - 1)); --to) *to = *(to - 1);
    *to = vertex;
  }
}

}  // namespace

void VertexRanks::sort(std::span<const double> values, std::span<const VertexId> ids) {
  const std::size_t n = values.size();
  order_.resize(n);
  if (n == 0) return;
  const Buckets bucket(values, n);
  fill_with_room(bucket_end_, n, 0u);
  for (const double value : values) ++bucket_end_[bucket(value)];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : bucket_end_) sum += std::exchange(end, sum);
  for (std::uint32_t i = 0; i < n; ++i) order_[bucket_end_[bucket(values[i])]++] = i;

  // Only vertices of the same bucket can be in the wrong order.
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : ids[a] < ids[b];
  };
  for (std::size_t i = 1; i < n; ++i) {
    if (!before(order_[i], order_[i - 1])) continue;
    const std::size_t b = bucket(values[order_[i]]);
    const std::uint32_t first = b == 0 ? 0 : bucket_end_[b - 1], last = bucket_end_[b];
    sort_bucket(order_.begin() + first, order_.begin() + last, before);
    i = last;
  }
}

}  // namespace reeb
