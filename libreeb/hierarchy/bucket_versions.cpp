#include "libreeb/hierarchy/bucket_versions.h"

#include <algorithm>
#include <limits>

namespace reeb {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

bool BucketVersions::cut(const ArcCut& arc) {
  if (lists_.empty(arc.from)) return false;
  const auto [lo, hi] = std::minmax(arc.start, arc.end);
  return lists_.cut(opposite(arc.direction), arc.from, arc.into, {value(lo), value(arc.node), value(hi)});
}

double BucketVersions::first_value(const ArcPart& part) {
  if (lists_.empty(part.arc)) return part.direction == kUp ? kNever : -kNever;
  const auto [lo, hi] = std::minmax(part.start, part.end);
  return lists_.first_value(part.direction, part.arc, value(lo), value(hi));
}

void BucketVersions::join(ArcId upper, ArcId lower, NodeId node) {
  lists_.merge(upper, lower);
  lists_.add(lower, value(node), graph_.positions.empty() ? std::array<double, 3>{} : graph_.positions[node.value()]);
}

void BucketVersions::drop(ArcId arc, std::uint32_t nodes) {
  if (const std::uint64_t count = lists_.drop(arc) + nodes; count != 0) sink_.drop({step_, count});
}

void BucketVersions::commit() {
  lists_.close();
  ++step_;
}

}  // namespace reeb
