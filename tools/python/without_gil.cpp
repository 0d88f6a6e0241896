#include "tools/python/without_gil.h"

#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace reeb::python {
namespace {

namespace py = pybind11;

std::atomic<int> working{0};                 // threads that the end must not find in the middle
std::atomic<bool> ending{false};             // set while the GIL is held
std::atomic<std::thread::id> ending_thread;  // which may go on to use this package

[[noreturn]] void stay_here() {
  for (;;) ::pause();
}

// REQUIRES: the GIL is held. Ctrl-C ends the waiting.
void wait_for_all() {
  constexpr std::chrono::milliseconds kBetweenLooks{10};
  ending_thread = std::this_thread::get_id();
  ending = true;
  while (working > 0) {
    {
      const py::gil_scoped_release released;
      std::this_thread::sleep_for(kBetweenLooks);
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
}

}  // namespace

WithoutGil::WithoutGil() : state_(PyEval_SaveThread()) {
  ++working;
  if (is_awaited()) {
    --working;
    stay_here();
  }
}

WithoutGil::~WithoutGil() {
  if (!is_awaited()) {
    PyEval_RestoreThread(state_);
    if (!is_awaited()) {
      --working;
      return;
    }
    PyEval_SaveThread();
  }
  --working;
  stay_here();
}

bool WithoutGil::is_awaited() { return ending && ending_thread.load() != std::this_thread::get_id(); }

void wait_at_exit() {
  // The other threads do not exist in a forked process.
  ::pthread_atfork(nullptr, nullptr, [] { working = 0; });
  py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_all));
}

}  // namespace reeb::python
