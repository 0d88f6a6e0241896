// Tells the thread sanitizer the order in which the filters of a TBB pipeline, or the calls of a parallel loop, run.
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace reeb::ooc {

// TBB's library is not instrumented. The sanitizer does not see that one filter passes an item to the next, nor that a
// serial filter runs once at a time, and would report every item as a race. This class states only what TBB guarantees,
// so races between items are still found. Empty without the sanitizer.
//
// Must exist until the pipeline has ended.
class PipelineOrder {
 public:
  PipelineOrder() = default;
  PipelineOrder(const PipelineOrder&) = delete;
  PipelineOrder& operator=(const PipelineOrder&) = delete;
  ~PipelineOrder() { observe(&end_); }

  // To call once the filters are made, before the pipeline starts: make_filter copies the captures of a filter, and the
  // threads of the pipeline read these copies.
  static void filters_are_made() { publish(&beginning); }

  // A filter calls this first, before it reads anything that it captured. One place for all pipelines, since the place
  // must be known without reading a capture.
  static void begin_filter() { observe(&beginning); }

  // Exists while a filter works on an item. `serial` names a filter that runs once at a time.
  class Filter {
   public:
    Filter(const PipelineOrder& order, const void* item, const void* serial = nullptr)
        : order_(order), item_(item), serial_(serial) {
      observe(item_);
      if (serial_ != nullptr) observe(serial_);
    }
    Filter(const Filter&) = delete;
    Filter& operator=(const Filter&) = delete;
    ~Filter() {
      publish(item_);
      if (serial_ != nullptr) publish(serial_);
      publish(&order_.end_);
    }

   private:
    const PipelineOrder& order_;
    const void* item_;
    const void* serial_;
  };

 private:
  // Everything before publish(p) happens before everything after a later observe(p).
#ifdef __SANITIZE_THREAD__
  static void publish(const void* p) { __tsan_release(const_cast<void*>(p)); }
  static void observe(const void* p) { __tsan_acquire(const_cast<void*>(p)); }
#else
  static void publish(const void*) {}
  static void observe(const void*) {}
#endif

  inline static char beginning = 0;
  char end_ = 0;
};

}  // namespace reeb::ooc
