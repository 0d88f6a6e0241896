// Port: where the history of arcs goes, so that in the end it is known on which arc each vertex lies
// (docs/ARCHITECTURE.md, Which arc a vertex lies on).
#pragma once

#include <cstdint>

#include "libreeb/base/sweep_key.h"
#include "libreeb/graph/direction.h"

namespace reeb {

// Arcs are named by numbers, which are used again when an arc is gone. Keys are those of vertices between the ends of
// the arcs that a call names.
//
// THREADS: called by one thread at a time, not always the same.
class ArcLog {
 public:
  using Arc = std::uint32_t;

  ArcLog() = default;
  ArcLog(const ArcLog&) = delete;
  ArcLog& operator=(const ArcLog&) = delete;
  virtual ~ArcLog() = default;

  // A new arc.
  virtual void add(Arc arc) = 0;
  // A regular vertex lies on the arc.
  virtual void place(Arc arc, const SweepKey& vertex) = 0;
  // Two arcs with the same ends are now `kept`.
  virtual void merge(Arc gone, Arc kept) = 0;
  // The part of `from` on this side of `at` is now part of `into`, which has the same ends as that part. The rest
  // stays.
  virtual void cut(Arc from, Arc into, const SweepKey& at, Direction side) = 0;
  // Two arcs meet at the vertex `at`: `gone` on this side of it, `kept` on the other. `kept` is now both, and `at` is a
  // regular vertex of it.
  virtual void join(Arc gone, Arc kept, const SweepKey& at, Direction side) = 0;
  // `gone`, on this side of the extremum `at`, is now part of `onto`, which starts where it starts, and goes on beyond
  // `at`. `at` is a regular vertex of `onto`.
  virtual void lay(Arc gone, Arc onto, const SweepKey& at, Direction side) = 0;
  // The arc and its vertices are dropped.
  virtual void drop(Arc arc) = 0;
  // Nothing changes the arc any more. The first arc that is settled has the number 0, the next one 1.
  virtual void settle(Arc arc) = 0;
  // The next `count` numbers are of arcs that were not added. Returns the first of them.
  virtual std::uint32_t settle_unnamed(std::uint32_t count) = 0;
  // A regular vertex lies on the arc that has this number.
  virtual void place_on_settled(std::uint32_t number, const SweepKey& vertex) = 0;
};

}  // namespace reeb
