// The order in which the filters of a TBB pipeline run, told to the thread sanitizer.
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace reeb::ooc {

// TBB's library is not instrumented: the sanitizer does not see that a piece is handed from one filter to the
// next, nor that a serial filter runs once at a time, and would report every piece as a race. What is said
// here is only what TBB guarantees, so that races between pieces are still found. Empty without the sanitizer.
//
// Lives from before the pipeline starts until it has ended.
class PipelineOrder {
 public:
  PipelineOrder() { publish(&begin_); }
  PipelineOrder(const PipelineOrder&) = delete;
  PipelineOrder& operator=(const PipelineOrder&) = delete;
  ~PipelineOrder() { observe(&end_); }

  // Lives while a filter works on a piece. `serial` names a filter that runs once at a time.
  class Filter {
   public:
    Filter(const PipelineOrder& order, const void* piece, const void* serial = nullptr)
        : order_(order), piece_(piece), serial_(serial) {
      observe(&order_.begin_);
      observe(piece_);
      if (serial_ != nullptr) observe(serial_);
    }
    Filter(const Filter&) = delete;
    Filter& operator=(const Filter&) = delete;
    ~Filter() {
      publish(piece_);
      if (serial_ != nullptr) publish(serial_);
      publish(&order_.end_);
    }

   private:
    const PipelineOrder& order_;
    const void* piece_;
    const void* serial_;
  };

 private:
  // What is done before publish(p) is done before what follows a later observe(p).
#ifdef __SANITIZE_THREAD__
  static void publish(const void* p) { __tsan_release(const_cast<void*>(p)); }
  static void observe(const void* p) { __tsan_acquire(const_cast<void*>(p)); }
#else
  static void publish(const void*) {}
  static void observe(const void*) {}
#endif

  char begin_ = 0, end_ = 0;
};

}  // namespace reeb::ooc
