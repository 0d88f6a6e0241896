// Disjoint sets of elements that come and go. What is known of a set is handed out when its last element is gone.
#pragma once

#include <cstdint>

#include "libreeb/containers/recycling_array.h"

namespace reeb::ooc {

// A set is named by any of the numbers that were returned for it; whoever keeps a number holds it. Elements of a set
// can be on either of two sides, which unite() relates. Value has join(const Value&).
//
// TIME: amortized O(log n).   MEMORY: as many sets as are held at most; those that were released are used again.
template <class Value>
class LiveSets {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Root {
    std::uint32_t set;
    bool flipped;  // the side of the number that was looked up, relative to the root
  };

  // A new set, held once.
  std::uint32_t add(const Value& value) {
    const std::uint32_t set = sets_.take();
    sets_[set] = {value, set, 1, false};
    return set;
  }

  Root find(std::uint32_t set) {
    bool flipped = false;
    for (std::uint32_t parent; (parent = sets_[set].parent) != set; set = sets_[set].parent) {
      const std::uint32_t above = sets_[parent].parent;
      if (above != parent) {
        ++sets_[above].holders;
        sets_[set].parent = above;
        sets_[set].flipped = sets_[set].flipped != sets_[parent].flipped;
        release(parent, [](const Value&) {});  // not a root, so no set ends
      }
      flipped = flipped != sets_[set].flipped;
    }
    return {set, flipped};
  }

  // The value of the whole set.
  Value& value(std::uint32_t set) { return sets_[find(set).set].value; }

  void hold(std::uint32_t set) { ++sets_[set].holders; }

  // Calls end(value) if the whole set is gone.
  template <class End>
  void release(std::uint32_t set, const End& end) {
    while (--sets_[set].holders == 0) {
      const std::uint32_t parent = sets_[set].parent;
      if (parent == set) end(sets_[set].value);
      sets_.free(set);
      if (parent == set) return;
      set = parent;
    }
  }

  // Says that both are one set, and that the two numbers are on different sides if `opposite`. False if they were one
  // set and this contradicts the sides that they had.
  bool unite(std::uint32_t a, std::uint32_t b, bool opposite = false) {
    const Root x = find(a), y = find(b);
    const bool flip = (x.flipped != y.flipped) != opposite;
    if (x.set == y.set) return !flip;
    sets_[x.set].value.join(sets_[y.set].value);
    sets_[y.set].parent = x.set;
    sets_[y.set].flipped = flip;
    ++sets_[x.set].holders;
    return true;
  }

  // Makes both the numbers of one set, which are held. Either can be kNone; if both are, the set begins with `value`.
  // One that is new takes the number of the other, so that sets are made and joined only where parts meet.
  void bind(std::uint32_t& a, std::uint32_t& b, const Value& value) {
    if (a == b && a != kNone) return;
    if (a == kNone && b == kNone) a = add(value);
    if (a == kNone)
      hold(a = find(b).set);
    else if (b == kNone)
      hold(b = find(a).set);
    else
      unite(a, b);
  }

  std::uint64_t memory_bytes() const { return sets_.memory_bytes(); }

 private:
  struct Set {
    Value value;
    std::uint32_t parent;   // itself if it is a root
    std::uint32_t holders;  // numbers that are kept, and sets below
    bool flipped;           // relative to the parent
    std::uint32_t& next_free() { return parent; }
  };

  RecyclingArray<Set> sets_;
};

}  // namespace reeb::ooc
