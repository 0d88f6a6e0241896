// Work without the GIL, and the end of Python meanwhile.
#pragma once

#include <pybind11/pybind11.h>

namespace reeb::python {

// Gives the GIL to other threads of Python, and takes it back. Python does not wait for its daemon threads: one that
// asks for the GIL at the end is ended by unwinding its stack, which aborts where C++ does not expect that. So the end
// waits here for the work of all threads, and these threads stop where they would take the GIL back.
class WithoutGil {
 public:
  // REQUIRES: the GIL is held.
  WithoutGil();
  ~WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;

  // Whether Python ends and waits for this thread: work that can be interrupted has to be.
  static bool is_awaited();

 private:
  PyThreadState* state_;
};

// Lets the end of Python wait. To be called once.
void wait_at_exit();

}  // namespace reeb::python
