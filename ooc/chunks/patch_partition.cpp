#include "ooc/chunks/patch_partition.h"

#include <algorithm>

#include "ooc/threads/parallel.h"

namespace reeb::ooc {

void PatchPartition::divide(const Chunk& chunk, std::size_t most) {
  constexpr std::size_t kSamplesAPatch = 256;
  const std::size_t stride = std::max<std::size_t>(1, most / kSamplesAPatch);
  cuts_.clear();
  patches_ = 0;
  sample_.clear();
  for (std::size_t i = 0; i < chunk.triangle_count(); i += stride) {
    Place& place = sample_.emplace_back();
    if (!chunk.positions.empty()) std::ranges::copy(chunk.positions[chunk.corners[3 * i]], place.begin());
    place[kStream] = static_cast<double>(i);
  }
  find_patches(chunk, cut(sample_, most / stride));
  collect(chunk);
}

// The chunks that follow wait until a stretch is divided, so all threads help. Most triangles share their first corner
// with another one.
void PatchPartition::find_patches(const Chunk& chunk, std::uint32_t root) {
  constexpr std::size_t kAtOnce = 16384;
  cuts_stream_ = std::ranges::any_of(cuts_, [](const Cut& cut) { return cut.axis == kStream; });
  patch_of_.resize(cuts_stream_ ? chunk.triangle_count() : chunk.vertex_count());
  in_parallel(threads_, (patch_of_.size() + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
    for (std::size_t i = part * kAtOnce; i < std::min((part + 1) * kAtOnce, patch_of_.size()); ++i) {
      Place place{};
      if (!chunk.positions.empty())
        std::ranges::copy(chunk.positions[cuts_stream_ ? chunk.corners[3 * i] : i], place.begin());
      place[kStream] = static_cast<double>(i);
      patch_of_[i] = patch_at(place, root);
    }
  });
}

// Returns the index of the cut that divides the sample, or its patch.
std::uint32_t PatchPartition::cut(std::span<Place> sample, std::size_t most) {
  if (sample.size() <= most) return kIsPatch | patches_++;
  Cut cut;
  const std::size_t below = divide_sample(sample, cut);
  const auto index = static_cast<std::uint32_t>(cuts_.size());
  cuts_.push_back(cut);
  const std::uint32_t lower = this->cut(sample.first(below), most);
  const std::uint32_t upper = this->cut(sample.subspan(below), most);
  cuts_[index].below = lower;
  cuts_[index].above = upper;
  return index;
}

// Puts the triangles below the cut first and returns their number: neither none nor all.
std::size_t PatchPartition::divide_sample(std::span<Place> sample, Cut& cut) {
  const auto cut_at_median = [&](std::size_t axis) {
    const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
    std::nth_element(sample.begin(), middle, sample.end(),
                     [axis](const Place& a, const Place& b) { return a[axis] < b[axis]; });
    cut.axis = axis;
    cut.at = (*middle)[axis];
    return static_cast<std::size_t>(
        std::partition(sample.begin(), middle, [&](const Place& place) { return place[axis] < cut.at; }) -
        sample.begin());
  };
  double longest = 0;
  std::size_t axis = kStream;
  for (std::size_t k = 0; k < kStream; ++k) {
    const auto [least, greatest] =
        std::ranges::minmax_element(sample, {}, [k](const Place& place) { return place[k]; });
    if (const double width = (*greatest)[k] - (*least)[k]; width > longest) {
      longest = width;
      axis = k;
    }
  }
  if (axis != kStream)
    if (const std::size_t below = cut_at_median(axis); 4 * below >= sample.size()) return below;
  return cut_at_median(kStream);
}

std::uint16_t PatchPartition::patch_at(const Place& place, std::uint32_t root) const {
  std::uint32_t at = root;
  while ((at & kIsPatch) == 0) {
    const Cut& cut = cuts_[at];
    at = place[cut.axis] < cut.at ? cut.below : cut.above;
  }
  return static_cast<std::uint16_t>(at);
}

void PatchPartition::collect(const Chunk& chunk) {
  const std::size_t n = chunk.triangle_count();
  const auto patch_of = [&](std::size_t i) { return patch_of_[cuts_stream_ ? i : chunk.corners[3 * i]]; };
  begin_.assign(patches_ + 1, 0);
  for (std::size_t i = 0; i < n; ++i) ++begin_[patch_of(i) + 1];
  for (std::size_t p = 0; p < patches_; ++p) begin_[p + 1] += begin_[p];
  triangles_.resize(n);
  for (std::size_t i = 0; i < n; ++i) triangles_[begin_[patch_of(i)]++] = static_cast<std::uint32_t>(i);
  // Now each entry has moved to where the next patch begins.
  begin_.insert(begin_.begin(), 0);
  begin_.pop_back();
  begin_.erase(std::unique(begin_.begin(), begin_.end()), begin_.end());
}

std::size_t PatchPartition::memory_bytes() const {
  return sample_.capacity() * sizeof(Place) + cuts_.capacity() * sizeof(Cut) + patch_of_.capacity() * 2 +
         (begin_.capacity() + triangles_.capacity()) * 4;
}

}  // namespace reeb::ooc
