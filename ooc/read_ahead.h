// Reading the next piece while the last one is used.
#pragma once

#include <future>
#include <utility>

namespace reeb::ooc {

// Calls read(piece) until it is false, and use(piece) for each piece in order. With `background` the
// next piece is read meanwhile, in another thread: one call of `read` at a time.
// THROWS: what read and use throw.   MEMORY: two pieces.
template <class Piece, class Read, class Use>
void read_ahead(bool background, const Read& read, const Use& use) {
  Piece piece, next;
  const auto read_next = [&] { return read(next); };
  const auto policy = background ? std::launch::async : std::launch::deferred;
  for (std::future<bool> more = std::async(policy, read_next); more.get();) {
    std::swap(piece, next);
    more = std::async(policy, read_next);
    use(piece);
  }
}

}  // namespace reeb::ooc
