#include "io/events/stream_event.h"

#include "libreeb/base/error.h"

namespace reeb::io {

bool EventReader::prepare() {
  if (at_ < count_) return true;
  if (fault_) std::rethrow_exception(fault_);
  at_ = count_ = 0;
  paused_ = false;
  try {
    fill();
  } catch (Error& error) {
    error.at(name_);
    fault_ = std::current_exception();
    if (count_ == 0) throw;
  }
  return !paused_;
}

bool EventReader::refill() {
  while (!prepare()) continue;
  return count_ != 0;
}

}  // namespace reeb::io
