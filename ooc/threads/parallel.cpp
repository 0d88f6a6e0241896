#include "ooc/threads/parallel.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "ooc/threads/kept_arena.h"
#include "ooc/threads/machine_threads.h"

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace reeb::ooc {
namespace {

// TBB's library is not instrumented. The thread sanitizer does not see that a loop's calls come after its start and
// before its end, and would report a race for each. This states only what TBB guarantees, so that races between calls
// are still found: all before publish(p) happens before all after a later observe(p). Without the sanitizer, nothing is
// done.
#ifdef __SANITIZE_THREAD__
void publish(char& place) { __tsan_release(&place); }
void observe(char& place) { __tsan_acquire(&place); }
#else
void publish(char&) {}
void observe(char&) {}
#endif

// TBB copies a loop's body, with its captures. So a call must know this place without reading a capture.
char start_of_loops = 0;

struct Loop {
  Loop() = default;
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;
  ~Loop() { observe(end); }
  char end = 0;
};

struct Call {
  explicit Call(Loop& loop_of_call) : loop(loop_of_call) {}
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;
  ~Call() { publish(loop.end); }
  Loop& loop;
};

}  // namespace

void in_parallel(unsigned threads, std::size_t count, const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = machine_threads();
  if (threads == 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  Loop loop;
  const auto body = [&](std::size_t i) {
    observe(start_of_loops);
    const Call call(loop);
    work(i);
  };
  run_in_kept_arena(threads, [&] {
    publish(start_of_loops);
    // A thread that waits here must not begin other work, which can take longer.
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, count, body); });
  });
}

}  // namespace reeb::ooc
