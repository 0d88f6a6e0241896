#include "libreeb/engine/bucket_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {

Bucket BucketSum::mean() const {
  Bucket bucket{index, count, {}};
  for (std::size_t k = 0; k < 3; ++k)
    bucket.mean[k] = static_cast<double>(sum[k]) * 0x1p-44 / static_cast<double>(count);
  return bucket;
}

void BucketLists::start(int exponent) {
  sums_.clear();
  links_.clear();
  first_free_ = kNone;
  indexer_ = BucketIndexer(exponent);
}

BucketLists::Index BucketLists::new_bucket(const BucketSum& bucket) {
  Index b = first_free_;
  if (b != kNone) {
    first_free_ = links_[b].next;
  } else {
    b = static_cast<Index>(sums_.size());
    sums_.grow_by(1);
    links_.grow_by(1);
  }
  sums_[b] = bucket;
  links_[b] = {bucket.index, b};
  return b;
}

void BucketLists::free_bucket(Index b) { links_[b].next = std::exchange(first_free_, b); }

void BucketLists::link_last(List& list, Index b) {
  links_[b].next = list.empty() ? b : std::exchange(links_[list.last].next, b);
  list.last = b;
}

// The bucket comes last, or becomes one with the last.
void BucketLists::link_or_add(List& list, Index b) {
  if (list.empty() || links_[list.last].index != links_[b].index) return link_last(list, b);
  sums_[list.last].add(sums_[b]);
  free_bucket(b);
}

void BucketLists::append(List& list, const BucketSum& bucket) {
  if (list.empty() || links_[list.last].index != bucket.index)
    link_last(list, new_bucket(bucket));
  else
    sums_[list.last].add(bucket);
}

void BucketLists::add_vertex(List& list, double value, const Point& position) {
  const std::int64_t index = indexer_(value);
  if (!list.empty() && links_[list.last].index == index) return sums_[list.last].add(position);
  List vertex;
  link_last(vertex, new_bucket({index, 0, {}}));
  sums_[vertex.last].add(position);
  merge(list, vertex);
}

void BucketLists::remove_first(List& list) {
  const Index first = links_[list.last].next;
  if (first == list.last)
    list.last = kNone;
  else
    links_[list.last].next = links_[first].next;
  free_bucket(first);
}

void BucketLists::concatenate(List& lower, List& upper) {
  if (upper.empty()) return;
  if (!lower.empty()) {
    const Index first = links_[upper.last].next;
    if (links_[lower.last].index == links_[first].index) {
      sums_[lower.last].add(sums_[first]);
      remove_first(upper);
      if (upper.empty()) return;
    }
    std::swap(links_[lower.last].next, links_[upper.last].next);
  }
  lower.last = std::exchange(upper.last, kNone);
}

void BucketLists::concatenate(List& lower, double value, const Point& position, List& upper) {
  const std::int64_t index = indexer_(value);
  if (Index first; lower.empty() && !upper.empty() && links_[first = links_[upper.last].next].index == index)
    sums_[first].add(position);
  else
    add_vertex(lower, value, position);
  concatenate(lower, upper);
}

void BucketLists::merge(List& into, List& from) {
  if (from.empty()) return;
  if (into.empty() || links_[into.last].index <= links_[links_[from.last].next].index)
    return concatenate(into, from);
  Index a = links_[into.last].next, b = links_[from.last].next;
  if (links_[from.last].index <= links_[a].index) {
    concatenate(from, into);
    std::swap(from, into);
    return;
  }
  links_[into.last].next = links_[from.last].next = kNone;
  List merged;
  while (a != kNone || b != kNone) {
    Index& least = b == kNone || (a != kNone && links_[a].index <= links_[b].index) ? a : b;
    link_or_add(merged, std::exchange(least, links_[least].next));
  }
  into = merged;
  from.last = kNone;
}

BucketLists::List BucketLists::take_above(List& list, double lo, double at, double hi) {
  if (list.empty()) return {};
  const std::int64_t above = first_above(lo, at, hi);
  if (links_[list.last].index < above) return {};
  const Index first = links_[list.last].next;
  if (links_[first].index >= above) return std::exchange(list, {});
  Index below = first, b = links_[first].next;
  while (links_[b].index < above) b = links_[below = b].next;
  const List taken = list;
  links_[below].next = std::exchange(links_[list.last].next, b);
  list.last = below;
  return taken;
}

// In halves, so that no difference overflows.
std::int64_t BucketLists::first_above(double lo, double at, double hi) const {
  const std::int64_t divided = indexer_(at);
  const double begin = indexer_(lo) == divided ? lo / 2 : std::ldexp(static_cast<double>(divided), exponent() - 1);
  const double end = indexer_(hi) == divided ? hi / 2 : std::ldexp(static_cast<double>(divided + 1), exponent() - 1);
  return end - at / 2 > at / 2 - begin ? divided : divided + 1;
}

void BucketLists::coarsen(List& list, int levels) {
  if (list.empty()) return;
  Index b = links_[list.last].next;
  links_[std::exchange(list.last, kNone)].next = kNone;
  while (b != kNone) {
    const Index next = links_[b].next;
    links_[b].index = sums_[b].index >>= std::min(levels, 63);
    link_or_add(list, b);
    b = next;
  }
}

void lay_on_path(BucketLists& lists, BucketLists::List& from, Direction d, double saddle,
                 double leaf, std::span<const PathBuckets> path) {
  double begin = saddle;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double end = path[i].end;
    BucketLists::List above = lists.take_above(from, std::min(begin, leaf), end, std::max(begin, leaf));
    if (d == kUp) std::swap(from, above);
    lists.merge(*path[i].list, above);
    begin = end;
  }
  lists.merge(*path.back().list, from);
}

void BucketLists::save(StateWriter& out) const {
  sums_.save(out);
  links_.save(out);
  out.put(first_free_);
  out.put(exponent());
}

void BucketLists::restore(StateReader& in) {
  sums_.restore(in);
  links_.restore(in);
  in.get(first_free_);
  indexer_ = BucketIndexer(in.get<int>());
}

}  // namespace reeb
