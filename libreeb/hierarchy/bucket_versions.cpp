#include "libreeb/hierarchy/bucket_versions.h"

#include <algorithm>

namespace reeb {

void BucketVersions::save(std::uint32_t arc) {
  if (saved_[arc] != kNone) return;
  saved_[arc] = static_cast<std::uint32_t>(saves_.size());
  const std::size_t begin = saved_buckets_.size();
  lists_.append_to(saved_buckets_, arc);
  saves_.push_back({arc, begin, saved_buckets_.size()});
}

bool BucketVersions::cut(const ArcCut& arc) {
  if (lists_.empty(arc.from)) return false;
  const auto [lo, hi] = std::minmax(arc.start, arc.end);
  const CutValues values{value(lo), value(arc.node), value(hi)};
  const Direction d = opposite(arc.direction);
  // Most nodes that a long arc is laid beside take nothing of it.
  if (!lists_.has_beyond(d, arc.from, values)) return false;
  save(arc.from);
  save(arc.into);
  return lists_.cut(d, arc.from, arc.into, values);
}

bool BucketVersions::merge(std::uint32_t from, std::uint32_t into) {
  if (lists_.empty(from)) return false;
  save(from);
  save(into);
  return lists_.merge(from, into);
}

void BucketVersions::join(std::uint32_t upper, std::uint32_t lower, std::uint32_t node) {
  save(upper);
  save(lower);
  lists_.merge(upper, lower);
  lists_.add(lower, value(node),
             graph_.positions.empty() ? std::array<double, 3>{} : graph_.positions[node]);
}

void BucketVersions::drop(std::uint32_t arc, std::uint32_t nodes) {
  save(arc);
  if (const std::uint64_t count = lists_.drop(arc) + nodes; count != 0) dropped_.push_back({step_, count});
}

void BucketVersions::end_record(std::uint32_t arc) {
  if (saved_[arc] == kNone) {
    lists_.append_to(ended_.buckets, arc);
  } else {
    const Saved& saved = saves_[saved_[arc]];
    ended_.buckets.insert(ended_.buckets.end(),
                          saved_buckets_.begin() + static_cast<std::ptrdiff_t>(saved.begin),
                          saved_buckets_.begin() + static_cast<std::ptrdiff_t>(saved.end));
  }
  ended_.offsets.push_back(ended_.buckets.size());
}

void BucketVersions::commit() {
  for (const Saved& saved : saves_) saved_[saved.arc] = kNone;
  saves_.clear();
  saved_buckets_.clear();
  ++step_;
}

}  // namespace reeb
