#include "libreeb/sweep/wide_sums.h"

#include <algorithm>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace reeb {
namespace {

constexpr double kUnit = 0x1p-44, kHighUnit = 0x1p35;  // of a high part, in units

}  // namespace

BucketSum WideSum::to_bucket() const {
  BucketSum bucket;
  bucket.count = static_cast<std::uint32_t>(count);
  bucket.rim = {rim[0], rim[1], rim[2]};
  bucket.moment = moment;
  for (std::size_t k = 0; k < 3; ++k) bucket.sum[k] = cut_off(high[k]) + cut_off(low[k]);
  return bucket;
}

#if defined(__x86_64__)

// A vector of four doubles is read at each position, whose fourth is of the next position, and is ignored. So the last
// position is read from a copy. Whether a vertex is in a bucket cannot be predicted, so it takes no branch: one that is
// in none is added to a sum that is not used.
[[gnu::target("avx2")]] std::size_t add_wide(std::span<WideSum> all_sums, std::span<const std::uint32_t> buckets,
                                             std::span<const Point> positions) {
  constexpr double kLeastFarSquare = 0x1p48;
  if (positions.empty()) return 0;
  WideSum* const sums = all_sums.data();  // stays in a register: no write to a sum can change it
  const auto last_sum = static_cast<std::uint32_t>(all_sums.size() - 1);
  const std::size_t count = std::min(positions.size(), kMostWideVertices);
  const std::array<Point, 2> last_position = {positions[count - 1], Point{}};
  // Where this is added and taken away again, a number is rounded to a multiple of kHighUnit.
  const __m256d rounder = _mm256_set1_pd(1.5 * 0x1p52 * kHighUnit);
  const __m256d scale = _mm256_set1_pd(1 / kUnit), one = _mm256_set1_pd(1);
  const Point* next = positions.data();
  for (std::size_t i = 0; i < count; ++i) {
    if (i + 1 == count) [[unlikely]]
      next = last_position.data();
    WideSum& sum = sums[std::min(buckets[i], last_sum)];
    const __m256d point = _mm256_loadu_pd((next++)->data());

    const __m256d squares = _mm256_mul_pd(point, point);
    const __m128d xy = _mm256_castpd256_pd128(squares), z = _mm256_extractf128_pd(squares, 1);
    const __m128d square = _mm_add_sd(_mm_add_sd(xy, _mm_unpackhi_pd(xy, xy)), z);
    if (!(_mm_cvtsd_f64(square) < kLeastFarSquare)) [[unlikely]]
      return i;

    const __m256d whole = _mm256_round_pd(_mm256_mul_pd(point, scale), _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
    const __m256d high = _mm256_sub_pd(_mm256_add_pd(whole, rounder), rounder);
    const __m256d low = _mm256_sub_pd(whole, high);
    // The moment and the count are the fourth numbers.
    const __m256d high_and_square = _mm256_blend_pd(high, _mm256_broadcastsd_pd(square), 0b1000);
    _mm256_storeu_pd(sum.high.data(), _mm256_add_pd(_mm256_loadu_pd(sum.high.data()), high_and_square));
    const __m256d low_and_one = _mm256_blend_pd(low, one, 0b1000);
    _mm256_storeu_pd(sum.low.data(), _mm256_add_pd(_mm256_loadu_pd(sum.low.data()), low_and_one));

    // As near_rim_of() and BucketSum::raise_rim().
    const __m128 near = _mm_add_ps(_mm256_cvtpd_ps(point), _mm_setzero_ps()), rim = _mm_loadu_ps(sum.rim.data());
    __m128 replaced = _mm_cmpgt_ps(near, rim);
    if (_mm_comieq_ss(near, rim) != 0) [[unlikely]] {
      const int higher = _mm_movemask_ps(replaced), equal = _mm_movemask_ps(_mm_cmpeq_ps(near, rim));
      const bool by_y_or_z = (higher & 0b10) != 0 || ((equal & 0b10) != 0 && (higher & 0b100) != 0);
      replaced = _mm_castsi128_ps(_mm_set1_epi32(by_y_or_z ? -1 : 0));
    }
    _mm_storeu_ps(sum.rim.data(), _mm_blendv_ps(rim, near, _mm_shuffle_ps(replaced, replaced, 0)));
  }
  return count;
}

#else

std::size_t add_wide(std::span<WideSum>, std::span<const std::uint32_t>, std::span<const Point>) { return 0; }

#endif

}  // namespace reeb
