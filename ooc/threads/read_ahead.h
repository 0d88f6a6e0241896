// Reading the next pieces while one is used.
#pragma once

#include <tbb/parallel_pipeline.h>

#include <array>
#include <cstddef>

#include "ooc/threads/kept_arena.h"
#include "ooc/threads/pipeline_order.h"

namespace reeb::ooc {

// Calls read(piece) until it is false, prepare(piece) for each piece, and use(piece) for each in order. With
// `background` two threads do so: one call of `read` at a time, one of `use`, and any of `prepare`.
// THROWS: what these throw.   MEMORY: three pieces.
template <class Piece, class Read, class Prepare, class Use>
void read_ahead(bool background, const Read& read, const Prepare& prepare, const Use& use) {
  if (!background) {
    for (Piece piece; read(piece);) {
      prepare(piece);
      use(piece);
    }
    return;
  }
  constexpr unsigned kThreads = 2;
  std::array<Piece, 3> pieces;
  std::size_t next = 0;
  const PipelineOrder order;
  const auto read_next = [&](tbb::flow_control& flow) -> Piece* {
    const PipelineOrder::Filter serial(order, &next);
    Piece& piece = pieces[next++ % pieces.size()];
    const PipelineOrder::Filter filter(order, &piece);
    if (read(piece)) return &piece;
    flow.stop();
    return nullptr;
  };
  const auto prepare_one = [&](Piece* piece) {
    const PipelineOrder::Filter filter(order, piece);
    prepare(*piece);
    return piece;
  };
  const auto use_one = [&](Piece* piece) {
    const PipelineOrder::Filter filter(order, piece, &use);
    use(*piece);
  };
  using tbb::filter_mode;
  run_in_kept_arena(kThreads, [&] {
    tbb::parallel_pipeline(pieces.size(), tbb::make_filter<void, Piece*>(filter_mode::serial_in_order, read_next) &
                                              tbb::make_filter<Piece*, Piece*>(filter_mode::parallel, prepare_one) &
                                              tbb::make_filter<Piece*, void>(filter_mode::serial_in_order, use_one));
  });
}

// The same without preparing.
template <class Piece, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  read_ahead<Piece>(
      background, read, [](Piece&) {}, use);
}

}  // namespace reeb::ooc
