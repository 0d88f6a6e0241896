#include "io/events/stream_event.h"

#include "libreeb/base/error.h"

namespace reeb::io {

bool EventReader::refill() {
  if (fault_) std::rethrow_exception(fault_);
  at_ = count_ = 0;
  try {
    fill();
  } catch (Error& error) {
    error.at(name_);
    fault_ = std::current_exception();
    if (count_ == 0) throw;
  }
  return count_ != 0;
}

}  // namespace reeb::io
