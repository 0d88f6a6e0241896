// Reads the next items while one is used.
#pragma once

#include <array>
#include <chrono>
#include <span>

#include "ooc/threads/work_in_order.h"

namespace reeb::ooc {

// Calls read(item) until it returns false, prepare(item) for each item, and use(item) for each in order. With
// `background`, two threads do this as in work_in_order.h, unless there is little to do.
//
// THROWS: what these throw.   MEMORY: items_for(2) items.
template <class Item, class Read, class Prepare, class Use>
void read_ahead(bool background, const Read& read, const Prepare& prepare, const Use& use) {
  // Starting a thread is worth it only for more work than this.
  constexpr auto kLittle = std::chrono::milliseconds(2);
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  for (Item item; !background || Clock::now() - start < kLittle;) {
    if (!read(item)) return;
    prepare(item);
    use(item);
  }
  std::array<Item, items_for(2)> items;
  work_in_order(2, std::span<Item>(items), read, prepare, use);
}

// The same without preparing.
template <class Item, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  read_ahead<Item>(
      background, read, [](Item&) {}, use);
}

}  // namespace reeb::ooc
