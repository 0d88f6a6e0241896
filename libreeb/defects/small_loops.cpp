#include "libreeb/defects/small_loops.h"

namespace reeb {

// What is found if `persistence` comes after the last loop.
SmallLoops LikelyDefects::with_next(double persistence) const {
  constexpr double kMostOfRange = 0.02;
  const bool is_gap = last_ > 0 && last_ <= kMostOfRange * range_ && persistence / last_ >= widest_;
  return is_gap ? SmallLoops{count_, last_} : found_;
}

void LikelyDefects::add(double persistence) {
  if (!(persistence > 0)) return;
  if (const SmallLoops found = with_next(persistence); found.count != found_.count) {
    found_ = found;
    widest_ = persistence / last_;
  }
  last_ = persistence;
  ++count_;
}

SmallLoops LikelyDefects::found() const { return with_next(range_); }

}  // namespace reeb
