#include "ooc/stored_graph/arc_ends.h"

#include <algorithm>
#include <iterator>

namespace reeb::ooc {

ArcEnds::ArcEnds(std::uint64_t vertices) {
  for (std::vector<bool>* bits : {&goes_up_, &goes_down_, &near_}) bits->resize(static_cast<std::size_t>(vertices));
}

std::vector<ArcKeys> ArcEnds::connected_to_extrema(std::span<const ArcKeys> arcs) {
  constexpr int kLooks = 16;
  for (const ArcKeys& arc : arcs)
    if (ends_in_extremum(arc)) near_[place(arc.lo)] = near_[place(arc.hi)] = true;
  int looks = 0;
  while (spread(arcs))
    if (++looks == kLooks) return {arcs.begin(), arcs.end()};
  const auto is_near = [&](const ArcKeys& arc) { return near_[place(arc.lo)]; };
  std::vector<ArcKeys> kept;
  kept.reserve(static_cast<std::size_t>(std::ranges::count_if(arcs, is_near)));
  std::ranges::copy_if(arcs, std::back_inserter(kept), is_near);
  return kept;
}

bool ArcEnds::spread(std::span<const ArcKeys> arcs) {
  bool changed = false;
  for (const ArcKeys& arc : arcs) {
    const bool lo = near_[place(arc.lo)], hi = near_[place(arc.hi)];
    if (lo == hi) continue;
    near_[place(arc.lo)] = near_[place(arc.hi)] = true;
    changed = true;
  }
  return changed;
}

}  // namespace reeb::ooc
