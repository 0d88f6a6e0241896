#include "libreeb/graph/bucket_sums.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"

namespace reeb {

// A NaN counts as the least coordinate, as in fixed_point().
void BucketSum::add_large(const Point& position) {
  constexpr double kMost = 0x1p50;
  Point clamped;
  for (std::size_t k = 0; k < 3; ++k) {
    sum[k] += fixed_point(position[k]);
    clamped[k] = position[k] > -kMost ? std::min(position[k], kMost) : -kMost;
  }
  moment += dot(clamped, clamped);
  raise_rim(near_rim_of(clamped));
}

void BucketSum::refuse_vertices() {
  throw Error(ErrorKind::kResource, "more than 2^32 - 1 vertices of an arc are in one bucket",
              "use more buckets (--buckets N), or leave out the embedding (--buckets 0)");
}

void BucketSum::keep(std::uint64_t kept, BucketSum& other) {
  other.check_room(count - static_cast<std::uint32_t>(kept));
  const double share = static_cast<double>(kept) / static_cast<double>(count);
  for (std::size_t k = 0; k < 3; ++k) {
    const Int128 part = cut_off(to_double(sum[k]) * share);
    other.sum[k] += sum[k] - part;
    sum[k] = part;
  }
  const double part = moment * share;
  other.moment += moment - part;
  moment = part;
  other.raise_rim(rim);
  other.count += count - static_cast<std::uint32_t>(kept);
  count = static_cast<std::uint32_t>(kept);
}

void BucketLists::start(int exponent) {
  sums_.clear();
  links_.clear();
  free_.clear();
  free_count_ = 0;
  indexer_ = BucketIndexer(exponent);
}

std::span<BucketSum> BucketLists::make(std::size_t count) {
  sums_.grow_by(count);
  links_.grow_by(count);
  free_.grow_by(count);
  return {sums_.data(), count};
}

BucketLists::Index BucketLists::new_bucket(const BucketSum& bucket) {
  Index b = 0;
  if (free_count_ != 0) {
    b = free_[--free_count_];
    // The next free bucket will be needed soon.
    if (free_count_ != 0) prefetch(List{free_[free_count_ - 1]});
  } else {
    b = static_cast<Index>(sums_.size());
    sums_.grow_by(1);
    links_.grow_by(1);
    free_.grow_by(1);
  }
  sums_[b] = bucket;
  links_[b] = {bucket.index, b};
  return b;
}

void BucketLists::link_last(List& list, Index b) {
  links_[b].next = list.empty() ? b : std::exchange(links_[list.last].next, b);
  list.last = b;
}

// Appends the bucket, or adds it to the last one if their indices are equal.
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
  if (!list.empty() && links_[list.last].index == index) return add_checked(list.last, position);
  List vertex;
  link_last(vertex, new_bucket({.index = index}));
  sums_[vertex.last].add(position);
  merge(list, vertex);
}

void BucketLists::add(List& list, const BucketSum& bucket) {
  if (list.empty() || links_[list.last].index <= bucket.index) return append(list, bucket);
  List one;
  append(one, bucket);
  merge(list, one);
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
    add_checked(first, position);
  else
    add_vertex(lower, value, position);
  concatenate(lower, upper);
}

void BucketLists::merge(List& into, List& from) {
  if (from.empty()) return;
  if (into.empty() || links_[into.last].index <= links_[links_[from.last].next].index) return concatenate(into, from);
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
  const std::int64_t divided = indexer_(at);
  if (links_[list.last].index < divided) return {};
  Index below = kNone, b = links_[list.last].next;  // the last one below `at`, and the one after it
  while (links_[b].index < divided) b = links_[below = b].next;
  if (links_[b].index == divided) {
    const std::uint64_t count = sums_[b].count, above = count_above(b, lo, at, hi);
    if (above == 0) {
      below = b;
    } else if (above < count) {
      const Index part = new_bucket(std::exchange(sums_[b], {.index = divided}));
      sums_[part].keep(count - above, sums_[b]);
      links_[below == kNone ? list.last : below].next = part;
      links_[part].next = b;
      below = part;
    }
  }
  return split_after(list, below);
}

void BucketLists::move_above(List& from, double lo, double at, double hi, List& into) {
  if (from.empty()) return;
  const std::int64_t divided = indexer_(at);
  const Index last = from.last;
  if (links_[last].index < divided) return;
  const Index to = into.empty() ? kNone : links_[into.last].next;
  if (to == kNone || links_[last].next != last || links_[last].index != divided || links_[to].index != divided) {
    List upper = take_above(from, lo, at, hi);
    return merge(into, upper);
  }
  const std::uint64_t count = sums_[last].count, above = count_above(last, lo, at, hi);
  if (above == 0) return;
  if (above < count) return sums_[last].keep(count - above, sums_[to]);
  sums_[to].add(sums_[last]);
  from.last = kNone;
  free_bucket(last);
}

// Takes the buckets after `last_below`, or all if that is kNone.
BucketLists::List BucketLists::split_after(List& list, Index last_below) {
  if (last_below == kNone) return std::exchange(list, {});
  if (last_below == list.last) return {};
  const List taken = list;
  links_[last_below].next = std::exchange(links_[list.last].next, links_[last_below].next);
  list.last = last_below;
  return taken;
}

// How many vertices of the bucket that contains `at` count as above it. Works on halved values, so that no difference
// overflows.
std::uint64_t BucketLists::count_above(Index bucket, double lo, double at, double hi) const {
  constexpr std::uint64_t kBucketDividesFrom = 4;  // vertices
  const std::int64_t index = links_[bucket].index;
  const double least = indexer_(lo) == index ? lo / 2 : std::ldexp(static_cast<double>(index), exponent() - 1);
  const double most = indexer_(hi) == index ? hi / 2 : std::ldexp(static_cast<double>(index + 1), exponent() - 1);
  const std::uint64_t count = sums_[bucket].count;
  if (count < kBucketDividesFrom) return most - at / 2 > at / 2 - least ? count : 0;
  const double share = most > least ? std::clamp((most - at / 2) / (most - least), 0.0, 1.0) : 0.5;
  return std::min(static_cast<std::uint64_t>(std::nearbyint(share * static_cast<double>(count))), count);
}

void BucketLists::coarsen(List& list, int levels) {
  if (list.empty()) return;
  if (levels < 0) throw DamagedState();  // only a restored list can be coarser
  Index b = links_[list.last].next;
  links_[std::exchange(list.last, kNone)].next = kNone;
  while (b != kNone) {
    const Index next = links_[b].next;
    links_[b].index = sums_[b].index >>= std::min(levels, 63);
    link_or_add(list, b);
    b = next;
  }
}

void lay_on_path(BucketLists& lists, BucketLists::List& from, Direction d, double saddle, double leaf,
                 std::span<const PathBuckets> path) {
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

void BucketLists::drain_means(List& list, ArcLists& lists) {
  if (list.empty()) return lists.add_packed({});
  std::size_t count = 1;
  for (Index b = links_[list.last].next; b != list.last; b = links_[b].next) ++count;
  lists.add(count, [&](const auto& add) { drain(list, [&](const BucketSum& sum) { add(sum.mean()); }); });
}

void BucketLists::save(StateWriter& out) const {
  sums_.save(out);
  links_.save(out);
  free_.save(out);
  out.put(free_count_);
  out.put(exponent());
}

void BucketLists::restore(StateReader& in) {
  constexpr int kMostExponent = 2048;  // more than that of any double
  sums_.restore(in);
  links_.restore(in);
  free_.restore(in);
  in.get(free_count_);
  const int exponent = in.get<int>();
  if (links_.size() != sums_.size() || free_.size() != sums_.size() || free_count_ > free_.size() ||
      exponent < -kMostExponent || exponent > kMostExponent)
    throw DamagedState();
  indexer_ = BucketIndexer(exponent);
}

void BucketLists::check_restored(std::span<const List> lists) const {
  constexpr Int128 kMostPerVertex = Int128{1} << 94;
  std::vector<bool> seen(sums_.size());
  const auto take = [&](Index b) {
    if (b >= seen.size() || seen[b]) throw DamagedState();
    seen[b] = true;
  };
  const auto check_sum = [&](Index b) {
    const BucketSum& bucket = sums_[b];
    if (bucket.count == 0 || !(bucket.moment >= 0 && bucket.moment < HUGE_VAL) || bucket.index != links_[b].index)
      throw DamagedState();
    const Int128 most = kMostPerVertex * static_cast<Int128>(bucket.count);
    for (const Int128 sum : bucket.sum)
      if (sum > most || sum < -most) throw DamagedState();
  };
  for (std::size_t i = 0; i < free_count_; ++i) take(free_[i]);
  for (const List& list : lists) {
    if (list.empty()) continue;
    take(list.last);
    check_sum(list.last);
    for (Index b = links_[list.last].next, next; b != list.last; b = next) {
      take(b);
      check_sum(b);
      next = links_[b].next;
      if (next >= seen.size() || links_[b].index > links_[next].index) throw DamagedState();
    }
  }
}

}  // namespace reeb
