#include "libreeb/engine/vertex_ranks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {
namespace {

// Numbers buckets of equal width from the least value to the greatest. Rounding is monotone in every step, so a greater
// value is never in a lower bucket.
class Buckets {
 public:
  Buckets(std::span<const double> values, std::size_t count) : last_(static_cast<double>(count - 1)) {
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    least_ = *least / 2;  // halved, so that no difference overflows
    const double scale = last_ / (*greatest / 2 - least_);
    scale_ = std::isfinite(scale) ? scale : 0;
  }
  std::size_t operator()(double value) const {
    return static_cast<std::size_t>(std::min((value / 2 - least_) * scale_, last_));
  }

 private:
  double last_, least_, scale_;
};

// Most buckets have a few vertices. A large one is a tie, whose vertices are often in order already.
template <class Iterator, class Before>
void sort_bucket(Iterator first, Iterator last, const Before& before) {
  constexpr std::ptrdiff_t kInsertionSortsUpTo = 8;
  if (last - first > kInsertionSortsUpTo) {
    if (!std::is_sorted(first, last, before)) std::sort(first, last, before);
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
  bucket_end_.assign(n, 0);
  for (const double value : values) ++bucket_end_[bucket(value)];
  std::uint32_t sum = 0;
  for (std::uint32_t& end : bucket_end_) sum += std::exchange(end, sum);
  for (std::uint32_t i = 0; i < n; ++i) order_[bucket_end_[bucket(values[i])]++] = i;

  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return values[a] != values[b] ? values[a] < values[b] : ids[a] < ids[b];
  };
  auto first = order_.begin();
  for (const std::uint32_t end : bucket_end_) {
    const auto last = order_.begin() + end;
    if (last - first > 1) sort_bucket(first, last, before);
    first = last;
  }
}

}  // namespace reeb
