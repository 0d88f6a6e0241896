#include "ooc/stored_graph/arc_ends.h"

namespace reeb::ooc {

ArcEnds::ArcEnds(std::uint64_t vertices) {
  for (std::vector<bool>* bits : {&goes_up_, &goes_down_, &near_}) bits->resize(static_cast<std::size_t>(vertices));
}

void ArcEnds::keep_connected_to_extrema(std::vector<ArcKeys>& arcs) {
  constexpr int kLooks = 16;
  for (const ArcKeys& arc : arcs)
    if (ends_in_extremum(arc)) near_[place(arc.lo)] = near_[place(arc.hi)] = true;
  int looks = 0;
  while (spread(arcs))
    if (++looks == kLooks) return;
  std::erase_if(arcs, [&](const ArcKeys& arc) { return !near_[place(arc.lo)]; });
}

bool ArcEnds::spread(const std::vector<ArcKeys>& arcs) {
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
