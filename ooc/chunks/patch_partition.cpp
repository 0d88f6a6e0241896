#include "ooc/chunks/patch_partition.h"

#include <algorithm>

#include "ooc/threads/parallel.h"

namespace reeb::ooc {

void PatchPartition::divide(const Chunk& chunk, std::size_t most) {
  // A cut leaves at least a quarter on each side, so there are fewer than 2^16 patches.
  constexpr std::size_t kSamplesAPatch = 256, kUsualPatches = 16000;
  const std::size_t n = chunk.triangle_count();
  most = std::max(most, n / kUsualPatches + 1);
  const std::size_t stride = std::max<std::size_t>(1, most / kSamplesAPatch);
  cuts_.clear();
  patches_ = 0;
  triangles_.clear();
  triangles_.reserve(n);
  for (std::size_t i = 0; i < n; i += stride) triangles_.push_back(static_cast<std::uint32_t>(i));
  const std::uint32_t root = cut(chunk, triangles_, most / stride);
  find_patches(chunk, root);
  collect(chunk);
}

// The patch of the place that has these coordinates: place_on(axis).
template <class PlaceOn>
std::uint16_t PatchPartition::patch_at(const PlaceOn& place_on, std::uint32_t root) const {
  std::uint32_t at = root;
  while ((at & kIsPatch) == 0) {
    const Cut& cut = cuts_[at];
    at = place_on(cut.axis) < cut.at ? cut.below : cut.above;
  }
  return static_cast<std::uint16_t>(at);
}

// The chunks that follow wait until a stretch is divided, so all threads help. Most triangles share their first corner
// with another one.
void PatchPartition::find_patches(const Chunk& chunk, std::uint32_t root) {
  constexpr std::size_t kAtOnce = 16384;
  cuts_stream_ = std::ranges::any_of(cuts_, [](const Cut& cut) { return cut.axis == kStream; });
  const std::size_t n = cuts_stream_ ? chunk.triangle_count() : chunk.vertex_count();
  patch_of_.resize(n);
  in_parallel(threads_, (n + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
    for (std::size_t i = part * kAtOnce; i < std::min((part + 1) * kAtOnce, n); ++i) {
      const auto place_on = [&](std::size_t axis) {
        return cuts_stream_ ? place(chunk, static_cast<std::uint32_t>(i), axis) : chunk.positions[i][axis];
      };
      patch_of_[i] = patch_at(place_on, root);
    }
  });
}

// Returns the index of the cut that divides the sample, or its patch.
std::uint32_t PatchPartition::cut(const Chunk& chunk, std::span<std::uint32_t> sample, std::size_t most) {
  if (sample.size() <= most) return kIsPatch | patches_++;
  Cut cut;
  const std::size_t below = divide_sample(chunk, sample, cut);
  const auto index = static_cast<std::uint32_t>(cuts_.size());
  cuts_.push_back(cut);
  const std::uint32_t lower = this->cut(chunk, sample.first(below), most);
  const std::uint32_t upper = this->cut(chunk, sample.subspan(below), most);
  cuts_[index].below = lower;
  cuts_[index].above = upper;
  return index;
}

// Puts the triangles below the cut first and returns their number: neither none nor all.
std::size_t PatchPartition::divide_sample(const Chunk& chunk, std::span<std::uint32_t> sample, Cut& cut) const {
  const auto cut_at_median = [&](std::size_t axis) {
    const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
    std::nth_element(sample.begin(), middle, sample.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return place(chunk, a, axis) < place(chunk, b, axis); });
    cut.axis = axis;
    cut.at = place(chunk, *middle, axis);
    return static_cast<std::size_t>(
        std::partition(sample.begin(), middle, [&](std::uint32_t t) { return place(chunk, t, axis) < cut.at; }) -
        sample.begin());
  };
  double longest = 0;
  std::size_t axis = kStream;
  for (std::size_t k = 0; k < kStream && !chunk.positions.empty(); ++k) {
    const auto [least, greatest] =
        std::minmax_element(sample.begin(), sample.end(),
                            [&](std::uint32_t a, std::uint32_t b) { return place(chunk, a, k) < place(chunk, b, k); });
    const double width = place(chunk, *greatest, k) - place(chunk, *least, k);
    if (width > longest) {
      longest = width;
      axis = k;
    }
  }
  if (axis != kStream)
    if (const std::size_t below = cut_at_median(axis); 4 * below >= sample.size()) return below;
  return cut_at_median(kStream);
}

// In the order of the stream, so that what is read and written is near what came before.
void PatchPartition::collect(const Chunk& chunk) {
  const std::size_t n = chunk.triangle_count();
  const auto patch_of = [&](std::size_t i) { return patch_of_[cuts_stream_ ? i : chunk.corners[3 * i]]; };
  std::vector<std::uint32_t> next(patches_);  // by patch: the place of its next triangle
  for (std::size_t i = 0; i < n; ++i) ++next[patch_of(i)];
  // A patch without triangles has no number.
  std::vector<std::uint16_t> number(patches_);
  begin_.assign(1, 0);
  for (std::uint32_t p = 0; p < patches_; ++p) {
    number[p] = static_cast<std::uint16_t>(begin_.size() - 1);
    const std::uint32_t begin = begin_.back();
    if (next[p] != 0) begin_.push_back(begin + next[p]);
    next[p] = begin;
  }
  triangles_.resize(n);
  last_patch_.assign(chunk.vertex_count(), 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint16_t patch = patch_of(i);
    triangles_[next[patch]++] = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint16_t& last = last_patch_[chunk.corners[3 * i + k]];
      last = std::max(last, static_cast<std::uint16_t>(number[patch] + 1));
    }
  }
  for (std::uint16_t& last : last_patch_) --last;  // 0 becomes kNoPatch
}

std::size_t PatchPartition::memory_bytes() const {
  return cuts_.capacity() * sizeof(Cut) + (patch_of_.capacity() + last_patch_.capacity()) * 2 +
         (begin_.capacity() + triangles_.capacity()) * 4;
}

}  // namespace reeb::ooc
