#include "libreeb/hierarchy/bucket_versions.h"

#include <algorithm>

namespace reeb {

bool BucketVersions::cut(const ArcCut& arc) {
  if (lists_.empty(arc.from)) return false;
  const auto [lo, hi] = std::minmax(arc.start, arc.end);
  const CutValues values{value(lo), value(arc.node), value(hi)};
  const Direction d = opposite(arc.direction);
  // Most nodes that a long arc is laid beside take nothing of it.
  return lists_.has_beyond(d, arc.from, values) && lists_.cut(d, arc.from, arc.into, values);
}

void BucketVersions::join(std::uint32_t upper, std::uint32_t lower, std::uint32_t node) {
  lists_.merge(upper, lower);
  lists_.add(lower, value(node),
             graph_.positions.empty() ? std::array<double, 3>{} : graph_.positions[node]);
}

void BucketVersions::drop(std::uint32_t arc, std::uint32_t nodes) {
  if (const std::uint64_t count = lists_.drop(arc) + nodes; count != 0) sink_.drop({step_, count});
}

void BucketVersions::commit() {
  lists_.close();
  ++step_;
}

}  // namespace reeb
