// Reading the next pieces while one is used.
#pragma once

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>

#include <array>
#include <cstddef>

#include "ooc/kept_arena.h"

namespace reeb::ooc {

// Calls read(piece) until it is false, and use(piece) for each piece in order. With `background` another
// thread reads meanwhile: one call of `read` at a time, and one of `use`.
// THROWS: what read and use throw.   MEMORY: three pieces.
template <class Piece, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  if (!background) {
    for (Piece piece; read(piece);) use(piece);
    return;
  }
  std::array<Piece, 3> pieces;
  std::size_t next = 0;
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 2);
  kept_arena(2).execute([&] {
    tbb::parallel_pipeline(pieces.size(), tbb::make_filter<void, Piece*>(tbb::filter_mode::serial_in_order,
                                                                         [&](tbb::flow_control& flow) -> Piece* {
                                                                           Piece& piece = pieces[next++ % pieces.size()];
                                                                           if (read(piece)) return &piece;
                                                                           flow.stop();
                                                                           return nullptr;
                                                                         }) &
                                              tbb::make_filter<Piece*, void>(tbb::filter_mode::serial_in_order,
                                                                             [&](Piece* piece) { use(*piece); }));
  });
}

}  // namespace reeb::ooc
