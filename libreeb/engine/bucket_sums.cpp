#include "libreeb/engine/bucket_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reeb {

BucketSum BucketSum::take(std::uint64_t taken) {
  BucketSum part{index, taken, {}};
  const double share = static_cast<double>(taken) / static_cast<double>(count);
  for (std::size_t k = 0; k < 3; ++k) {
    part.sum[k] = static_cast<Int128>(static_cast<double>(sum[k]) * share);
    sum[k] -= part.sum[k];
  }
  count -= taken;
  return part;
}

Bucket BucketSum::mean() const {
  Bucket bucket{index, count, {}};
  for (std::size_t k = 0; k < 3; ++k)
    bucket.mean[k] = static_cast<double>(sum[k]) * 0x1p-44 / static_cast<double>(count);
  return bucket;
}

void BucketLists::start(int exponent) {
  sums_.clear();
  next_.clear();
  first_free_ = kNone;
  exponent_ = exponent;
}

BucketLists::Index BucketLists::new_bucket(const BucketSum& bucket) {
  Index b = first_free_;
  if (b != kNone) {
    first_free_ = next_[b];
    sums_[b] = bucket;
    return b;
  }
  b = static_cast<Index>(sums_.size());
  sums_.grow_by(1);
  next_.grow_by(1);
  sums_[b] = bucket;
  next_[b] = b;
  return b;
}

void BucketLists::free_bucket(Index b) { next_[b] = std::exchange(first_free_, b); }

void BucketLists::link_last(List& list, Index b) {
  next_[b] = list.empty() ? b : std::exchange(next_[list.last], b);
  list.last = b;
}

void BucketLists::append_bucket(List& list, const BucketSum& bucket) {
  list.exponent = exponent_;
  link_last(list, new_bucket(bucket));
}

void BucketLists::append(List& list, const BucketSum& bucket) {
  if (list.empty() || sums_[list.last].index != bucket.index)
    append_bucket(list, bucket);
  else
    sums_[list.last].add(bucket);
}

void BucketLists::add_vertex(List& list, double value, const Point& position) {
  bring_up(list);
  const std::int64_t index = index_of(value);
  if (list.empty() || sums_[list.last].index <= index) return add_last(list, index, position);
  List vertex;
  add_last(vertex, index, position);
  merge(list, vertex);
}

void BucketLists::remove_first(List& list) {
  const Index first = next_[list.last];
  if (first == list.last)
    list.last = kNone;
  else
    next_[list.last] = next_[first];
  free_bucket(first);
}

void BucketLists::concatenate(List& lower, List& upper) {
  bring_up(lower);
  bring_up(upper);
  if (!lower.empty() && !upper.empty() &&
      sums_[lower.last].index == sums_[next_[upper.last]].index) {
    sums_[lower.last].add(sums_[next_[upper.last]]);
    remove_first(upper);
  }
  if (upper.empty()) return;
  if (!lower.empty()) std::swap(next_[lower.last], next_[upper.last]);
  lower.last = std::exchange(upper.last, kNone);
}

void BucketLists::merge(List& into, List& from) {
  bring_up(into);
  bring_up(from);
  if (from.empty()) return;
  if (into.empty() || sums_[into.last].index <= sums_[next_[from.last]].index)
    return concatenate(into, from);
  if (sums_[from.last].index <= sums_[next_[into.last]].index) {
    concatenate(from, into);
    std::swap(from, into);
    return;
  }
  Index a = next_[into.last], b = next_[from.last];
  next_[into.last] = next_[from.last] = kNone;
  List merged{kNone, exponent_};
  while (a != kNone || b != kNone) {
    Index& least = b == kNone || (a != kNone && sums_[a].index <= sums_[b].index) ? a : b;
    link_or_add(merged, std::exchange(least, next_[least]));
  }
  into = merged;
  from.last = kNone;
}

BucketLists::List BucketLists::take_above(List& list, double lo, double at, double hi) {
  bring_up(list);
  if (list.empty()) return {};
  const std::int64_t divided = index_of(at);
  Index below = kNone, b = next_[list.last];  // the last one below `at`, and the one after it
  const auto step = [&] { b = next_[below = b]; };
  while (sums_[b].index < divided && below != list.last) step();
  if (below != list.last && sums_[b].index == divided) {
    const std::uint64_t count = sums_[b].count, above = count_above(sums_[b], lo, at, hi);
    if (above == 0) {
      step();
    } else if (above < count) {
      const Index part = new_bucket(sums_[b].take(count - above));
      next_[below == kNone ? list.last : below] = part;
      next_[part] = b;
      below = part;
    }
  }
  if (below == list.last) return {};
  if (below == kNone) return std::exchange(list, {});
  const List taken = list;
  next_[below] = std::exchange(next_[list.last], b);
  list.last = below;
  return taken;
}

// In halves, so that no difference overflows.
std::uint64_t BucketLists::count_above(const BucketSum& bucket, double lo, double at,
                                       double hi) const {
  const auto index = static_cast<double>(bucket.index);
  const double least = std::max(lo / 2, std::ldexp(index, exponent_ - 1));
  const double most = std::min(hi / 2, std::ldexp(index + 1, exponent_ - 1));
  const double share = most > least ? std::clamp((most - at / 2) / (most - least), 0.0, 1.0) : 0.5;
  const double above = std::nearbyint(share * static_cast<double>(bucket.count));
  return std::min(static_cast<std::uint64_t>(above), bucket.count);
}

void BucketLists::coarsen(List& list) {
  const int shift = std::min(exponent_ - list.exponent, 63);
  list.exponent = exponent_;
  if (list.empty()) return;
  Index b = next_[list.last];
  next_[std::exchange(list.last, kNone)] = kNone;
  while (b != kNone) {
    sums_[b].index >>= shift;
    link_or_add(list, std::exchange(b, next_[b]));
  }
}

// The bucket comes last, or becomes one with the last.
void BucketLists::link_or_add(List& list, Index b) {
  if (list.empty() || sums_[list.last].index != sums_[b].index) return link_last(list, b);
  sums_[list.last].add(sums_[b]);
  free_bucket(b);
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
  next_.save(out);
  out.put(first_free_);
  out.put(exponent_);
}

void BucketLists::restore(StateReader& in) {
  sums_.restore(in);
  next_.restore(in);
  in.get(first_free_);
  in.get(exponent_);
}

}  // namespace reeb
