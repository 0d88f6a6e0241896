#include "libreeb/sweep/arc_slots.h"

#include <algorithm>
#include <cstddef>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace reeb {

#if defined(__x86_64__)

// Whether a vertex is on an arc cannot be predicted, so it takes no branch.
[[gnu::target("avx2")]] void find_slots(std::span<const double> values, const IdVector<LocalVertex, SweepArc>& arcs,
                                        std::span<const ArcSlots> slots, const BucketIndexer& indexer,
                                        std::int64_t first_index, std::span<std::uint32_t> result) {
  static_assert(sizeof(ArcSlots) == 8 && sizeof(SweepArc) == 4);
  const auto no_arc = static_cast<std::uint32_t>(slots.size() - 1);
  const __m256d scale = _mm256_set1_pd(indexer.scale()), first = _mm256_set1_pd(static_cast<double>(first_index));
  const __m128i none = _mm_set1_epi32(static_cast<int>(no_arc));
  const auto* const from = reinterpret_cast<const int*>(slots.data());
  const SweepArc* const arc = &*arcs.begin();
  const std::size_t n = result.size();
  std::size_t v = 0;
  for (; v + 4 <= n; v += 4) {
    const __m256d index = _mm256_floor_pd(_mm256_mul_pd(_mm256_loadu_pd(&values[v]), scale));
    const __m128i from_first = _mm256_cvttpd_epi32(_mm256_sub_pd(index, first));
    const __m128i arc4 = _mm_min_epu32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(arc + v)), none);
    const __m128i slot = _mm_add_epi32(_mm_i32gather_epi32(from, arc4, 8), from_first);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(&result[v]), slot);
  }
  for (; v < n; ++v)
    result[v] =
        slots[std::min(arc[v].value(), no_arc)].from + static_cast<std::uint32_t>(indexer(values[v]) - first_index);
}

#else

void find_slots(std::span<const double>, const IdVector<LocalVertex, SweepArc>&, std::span<const ArcSlots>,
                const BucketIndexer&, std::int64_t, std::span<std::uint32_t>) {}

#endif

}  // namespace reeb
