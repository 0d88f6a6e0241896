// Reads the next items while one is used.
#pragma once

#include <tbb/parallel_pipeline.h>

#include <array>
#include <cstddef>

#include "ooc/threads/kept_arena.h"
#include "ooc/threads/pipeline_order.h"

namespace reeb::ooc {

// Calls read(item) until it returns false, prepare(item) for each item, and use(item) for each in order. With
// `background`, two threads do this: one call of `read` at a time, one of `use`, and any number of `prepare`.
// THROWS: what these throw.   MEMORY: three items.
template <class Item, class Read, class Prepare, class Use>
void read_ahead(bool background, const Read& read, const Prepare& prepare, const Use& use) {
  if (!background) {
    for (Item item; read(item);) {
      prepare(item);
      use(item);
    }
    return;
  }
  constexpr unsigned kThreads = 2;
  std::array<Item, 3> pieces;
  std::size_t next = 0;
  const PipelineOrder order;
  const auto read_next = [&](tbb::flow_control& flow) -> Item* {
    PipelineOrder::begin_filter();
    const PipelineOrder::Filter serial(order, &next);
    Item& item = pieces[next++ % pieces.size()];
    const PipelineOrder::Filter filter(order, &item);
    if (read(item)) return &item;
    flow.stop();
    return nullptr;
  };
  const auto prepare_one = [&](Item* item) {
    PipelineOrder::begin_filter();
    const PipelineOrder::Filter filter(order, item);
    prepare(*item);
    return item;
  };
  const auto use_one = [&](Item* item) {
    PipelineOrder::begin_filter();
    const PipelineOrder::Filter filter(order, item, &use);
    use(*item);
  };
  using tbb::filter_mode;
  const auto filters = tbb::make_filter<void, Item*>(filter_mode::serial_in_order, read_next) &
                       tbb::make_filter<Item*, Item*>(filter_mode::parallel, prepare_one) &
                       tbb::make_filter<Item*, void>(filter_mode::serial_in_order, use_one);
  run_in_kept_arena(kThreads, [&] {
    PipelineOrder::filters_are_made();
    tbb::parallel_pipeline(pieces.size(), filters);
  });
}

// The same without preparing.
template <class Item, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  read_ahead<Item>(
      background, read, [](Item&) {}, use);
}

}  // namespace reeb::ooc
