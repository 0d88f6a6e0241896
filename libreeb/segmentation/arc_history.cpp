#include "libreeb/segmentation/arc_history.h"

#include "libreeb/base/hash.h"

namespace reeb {

std::uint32_t ArcHistory::undo(const ArcEvent& event) {
  using enum ArcEvent::Kind;
  const Arc arc = event.arc, other = event.other;
  switch (event.kind) {
    case kAdd:
      release(list(arc));
      break;
    case kPlace:
      return find(arc, event.key);
    case kMerge:
      list(arc) = copy(list(other));
      break;
    case kCut: {
      const List rest = std::exchange(list(arc), {}), part = copy(list(other));
      list(arc) = event.side == kUp ? concatenate(rest, part, event.key) : concatenate(part, rest, event.key);
      break;
    }
    case kJoin: {
      const std::uint32_t at = find(other, event.key);
      auto [below, above] = divide(std::exchange(list(other), {}), event.key);
      list(arc) = event.side == kUp ? above : below;
      list(other) = event.side == kUp ? below : above;
      return at;
    }
    case kLay: {
      auto [below, above] = divide(copy(list(other)), event.key);
      release(event.side == kUp ? below : above);
      list(arc) = event.side == kUp ? above : below;
      return find(other, event.key);
    }
    case kDrop:
      list(arc) = {};
      break;
    case kSettle:
      list(arc) = {other, kNone};
      break;
  }
  return kDropped;
}

// ---- lists

ArcHistory::List& ArcHistory::list(Arc arc) {
  while (lists_.size() <= arc) lists_.append({});
  return lists_[arc];
}

void ArcHistory::release(List& list) {
  drop(list.changes);
  list = {};
}

std::uint32_t ArcHistory::find(Arc arc, const SweepKey& vertex) const {
  if (arc >= lists_.size()) return kDropped;
  std::uint32_t found = lists_[arc].first;
  for (Index root = lists_[arc].changes; root != kNone;) {
    const Change& change = changes_[root];
    if (change.at < vertex) {
      found = change.arc;
      root = change.right;
    } else {
      root = change.left;
    }
  }
  return found;
}

std::uint32_t ArcHistory::last_of(const List& list) const {
  if (list.changes == kNone) return list.first;
  Index last = list.changes;
  while (changes_[last].right != kNone) last = changes_[last].right;
  return changes_[last].arc;
}

std::pair<ArcHistory::List, ArcHistory::List> ArcHistory::divide(List list, const SweepKey& at) {
  const auto [below, above] = split(list.changes, at);
  std::pair<List, List> parts{{list.first, below}, {0, above}};
  parts.second.first = last_of(parts.first);
  if (above == kNone) return parts;
  Index first = above;
  while (changes_[first].left != kNone) first = changes_[first].left;
  if (changes_[first].at == at) parts.second = {changes_[first].arc, without_first(above)};
  return parts;
}

// The lists meet at `at`. There is no change if the same settled arc is on both sides.
ArcHistory::List ArcHistory::concatenate(List below, List above, const SweepKey& at) {
  if (last_of(below) != above.first) below.changes = merge(below.changes, make(at, above.first));
  return {below.first, merge(below.changes, above.changes)};
}

// ---- trees

ArcHistory::Index ArcHistory::make(SweepKey at, std::uint32_t arc) {
  Index made = first_free_;
  if (made != kNone) {
    first_free_ = changes_[made].left;
  } else {
    made = static_cast<Index>(changes_.size());
    changes_.grow_by(1);
  }
  changes_[made] = {at, arc, kNone, kNone, static_cast<std::uint32_t>(mix(++made_)), 1};
  return made;
}

void ArcHistory::drop(Index root) {
  while (root != kNone && --changes_[root].users == 0) {
    drop(changes_[root].left);
    const Index right = changes_[root].right;
    changes_[root].left = std::exchange(first_free_, root);
    root = right;
  }
}

// The same change, with no other user.
ArcHistory::Index ArcHistory::own(Index root) {
  if (changes_[root].users == 1) return root;
  const Index copied = make(changes_[root].at, changes_[root].arc);
  Change& copy = changes_[copied];
  const Change& shared = changes_[root];
  copy.left = shared.left;
  copy.right = shared.right;
  copy.priority = shared.priority;
  keep(copy.left);
  keep(copy.right);
  drop(root);
  return copied;
}

// The changes before `at`, and the others.
std::pair<ArcHistory::Index, ArcHistory::Index> ArcHistory::split(Index root, const SweepKey& at) {
  if (root == kNone) return {kNone, kNone};
  root = own(root);
  if (changes_[root].at < at) {
    const auto [below, above] = split(changes_[root].right, at);
    changes_[root].right = below;
    return {root, above};
  }
  const auto [below, above] = split(changes_[root].left, at);
  changes_[root].left = above;
  return {below, root};
}

ArcHistory::Index ArcHistory::merge(Index below, Index above) {
  if (below == kNone) return above;
  if (above == kNone) return below;
  if (changes_[below].priority > changes_[above].priority) {
    below = own(below);
    const Index right = merge(changes_[below].right, above);
    changes_[below].right = right;
    return below;
  }
  above = own(above);
  const Index left = merge(below, changes_[above].left);
  changes_[above].left = left;
  return above;
}

ArcHistory::Index ArcHistory::without_first(Index root) {
  root = own(root);
  if (changes_[root].left != kNone) {
    const Index left = without_first(changes_[root].left);
    changes_[root].left = left;
    return root;
  }
  const Index right = changes_[root].right;
  keep(right);
  drop(root);
  return right;
}

}  // namespace reeb
