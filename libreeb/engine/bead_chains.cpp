#include "libreeb/engine/bead_chains.h"

#include <algorithm>
#include <utility>

namespace reeb {

BeadChains::Chain BeadChains::make(const SweepKey& key, const Point& position, BucketLists::List buckets) {
  const Index b = beads_.take();
  beads_[b] = {key, b, buckets};
  if (track_positions_) {
    if (positions_.size() < beads_.size()) positions_.grow_by(1);
    positions_[b] = position;
  }
  return {b};
}

BeadChains::Chain BeadChains::joined(Chain upper, Chain lower) {
  if (upper.empty() || lower.empty()) return upper.empty() ? lower : upper;
  std::swap(beads_[upper.lowest].below, beads_[lower.lowest].below);
  return lower;
}

void BeadChains::append(Chain& chain, Index bead) {
  beads_[bead].below = chain.empty() ? bead : std::exchange(beads_[chain.lowest].below, bead);
  chain.lowest = bead;
}

BeadChains::Chain BeadChains::without_lowest(Chain chain) {
  const Index first = highest(chain);
  if (first == chain.lowest) return {};
  Index last = first;
  while (beads_[last].below != chain.lowest) last = beads_[last].below;
  beads_[last].below = first;
  return {last};
}

std::size_t BeadChains::growth_bytes(std::size_t beads) const {
  const std::size_t more = beads - std::min(beads, beads_.size() - beads_.used());
  return more * (sizeof(Bead) + (track_positions_ ? sizeof(Point) : 0));
}

void BeadChains::save(StateWriter& out) const {
  beads_.save(out);
  positions_.save(out);
}

void BeadChains::restore(StateReader& in) {
  beads_.restore(in);
  positions_.restore(in);
  if (positions_.size() != (track_positions_ ? beads_.size() : 0)) throw DamagedState();
}

BeadChains::RestoredCheck::RestoredCheck(BeadChains& beads) : beads_(beads), seen_(beads.beads_.restored_free()) {}

void BeadChains::RestoredCheck::check(Chain chain, const SweepKey& lo, const SweepKey& hi) {
  if (chain.empty()) return;
  const auto next = [&](Index b) {
    if (b >= seen_.size()) throw DamagedState();
    return beads_.beads_[b].below;
  };
  const SweepKey* above = &hi;
  for (Index b = next(chain.lowest);; b = next(b)) {
    if (b >= seen_.size() || seen_[b]) throw DamagedState();
    const SweepKey& key = beads_.key(b);
    if (!(lo < key && key < *above) || key.vertex.value() + 1 == 0) throw DamagedState();
    seen_[b] = true;
    above = &key;
    if (b == chain.lowest) return;
  }
}

void BeadChains::RestoredCheck::end() const {
  if (std::find(seen_.begin(), seen_.end(), false) != seen_.end()) throw DamagedState();
}

}  // namespace reeb
