#include "ooc/run/pipeline.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "libreeb/engine/glue.h"
#include "libreeb/grid/box_glue.h"
#include "libreeb/grid/box_sweep.h"
#include "libreeb/sweep/chunk_sweep.h"
#include "ooc/threads/work_in_order.h"

namespace reeb::ooc {
namespace {

// What chunks are swept and glued with.
struct Triangles {
  using Sweep = ChunkSweep;
  using Glue = reeb::Glue;
  static std::unique_ptr<Glue> make_glue(GraphSink& sink, ArcLog* log) {
    auto glue = std::make_unique<Glue>(sink, true);
    if (log != nullptr) glue->set_log(*log);
    return glue;
  }
};
struct Boxes {
  using Sweep = BoxSweep;
  using Glue = BoxGlue;
  static std::unique_ptr<Glue> make_glue(GraphSink& sink, ArcLog*) { return std::make_unique<Glue>(sink); }
};

// Scratch memory for sweeping.
template <class Sweep>
struct Sweeper {
  explicit Sweeper(MemoryBudget& budget) : reservation(budget.reserve("chunk sweep", 0)) {}

  Sweep sweep;
  Reservation reservation;
};

// The sweepers. There is one for each chunk that is swept at the same time.
template <class Sweep>
class Sweepers {
 public:
  explicit Sweepers(MemoryBudget& budget) : budget_(budget) {}

  std::unique_ptr<Sweeper<Sweep>> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Sweeper<Sweep>>(budget_);
    auto sweeper = std::move(free_.back());
    free_.pop_back();
    return sweeper;
  }
  void give_back(std::unique_ptr<Sweeper<Sweep>> sweeper) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(sweeper));
  }

 private:
  MemoryBudget& budget_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Sweeper<Sweep>>> free_;
};

struct Slot {
  explicit Slot(MemoryBudget& budget) : reservation(budget.reserve("chunks in flight", 0)) {}
  WorkItem item;
  SourceProgress progress;  // from the reader, which can be further when the chunk is glued
  Reservation reservation;
};

template <class Kind>
class Pipeline {
 public:
  Pipeline(ChunkSource& source, std::span<GraphSink* const> sinks, MemoryBudget& budget, const PipelineOptions& options)
      : source_(source), budget_(budget), options_(options), live_(budget.reserve("live graph", 0)) {
    for (GraphSink* sink : sinks) glues_.push_back(Kind::make_glue(*sink, options.log));
    if (options.saved_engine != nullptr) restore(*options.saved_engine);
  }

  PipelineResult run() {
    run_steps();
    PipelineResult result{maximum_, {}, restored_vertex_bound_};
    for (const auto& glue : glues_) result.removed_pairs.push_back(glue->removed_pairs());
    if constexpr (std::is_same_v<Kind, Triangles>)
      for (std::size_t f = 0; options_.at_end && f < glues_.size(); ++f) options_.at_end(f, *glues_[f]);
    return result;
  }

 private:
  using Sweep = typename Kind::Sweep;

  void save(StateWriter& out) const {
    out.put(maximum_);
    for (const auto& glue : glues_) glue->save(out);
  }

  void restore(StateReader& in) {
    in.get(maximum_);
    for (const auto& glue : glues_) {
      glue->restore(in);
      restored_vertex_bound_ = std::max(restored_vertex_bound_, glue->vertex_bound());
    }
  }

  bool read(Slot& slot) {
    // Before the memory is taken: the next chunk will hardly be smaller than the largest one so far.
    reserve_at_least(slot.reservation, largest_item_);
    if (!source_.next(slot.item)) return false;
    slot.progress = {source_.bytes_read(), source_.bytes_total(), source_.triangles_read()};
    const std::uint64_t bytes = slot.item.memory_bytes();
    slot.reservation.resize(bytes);
    largest_item_ = std::max(largest_item_, bytes);
    return true;
  }

  static void reserve_at_least(Reservation& reservation, std::uint64_t bytes) {
    if (bytes > reservation.bytes()) reservation.resize(bytes);
  }

  void sweep(Slot& slot, Sweeper<Sweep>& sweeper) {
    slot.item.fragments.resize(glues_.size());
    reserve_at_least(sweeper.reservation, Sweep::least_memory_bytes(slot.item.chunk));
    for (std::size_t f = 0; f < glues_.size(); ++f)
      sweeper.sweep.run(slot.item.chunk, slot.item.values[f], slot.item.fragments[f], sweep_options(slot.item, f));
    sweeper.reservation.resize(sweeper.sweep.memory_bytes());
    slot.reservation.resize(slot.item.memory_bytes());
  }

  SweepOptions sweep_options(const WorkItem& item, std::size_t function) const {
    return options_.choose_sweep ? options_.choose_sweep(function, item.end.ranges[function]) : SweepOptions{};
  }

  static void add(Glue& glue, const Fragment& fragment, const std::function<void(std::size_t)>& grown) {
    glue.add(fragment, grown);
  }
  // Has no paths that grow.
  static void add(BoxGlue& glue, const Fragment& fragment, const std::function<void(std::size_t)>& /*grown*/) {
    glue.add(fragment);
  }

  void glue(Slot& slot) {
    std::size_t bytes = 0;
    for (std::size_t f = 0; f < glues_.size(); ++f) bytes += glues_[f]->memory_bytes_with(slot.item.fragments[f]);
    reserve_at_least(live_, bytes);
    LiveMaximum now;
    for (std::size_t f = 0; f < glues_.size(); ++f) {
      const std::size_t others = bytes - glues_[f]->memory_bytes_with(slot.item.fragments[f]);
      add(*glues_[f], slot.item.fragments[f], [&](std::size_t own) { reserve_at_least(live_, others + own); });
      now.vertices += glues_[f]->live_vertices();
      now.edges += glues_[f]->live_edges();
      now.arcs += glues_[f]->live_arcs();
      bytes = others + glues_[f]->memory_bytes();
    }
    live_.resize(bytes);
    maximum_.vertices = std::max(maximum_.vertices, now.vertices);
    maximum_.edges = std::max(maximum_.edges, now.edges);
    maximum_.arcs = std::max(maximum_.arcs, now.arcs);
    maximum_.bytes = std::max<std::uint64_t>(maximum_.bytes, bytes);
    if (options_.progress) options_.progress(slot.progress);
    if (options_.between_chunks && slot.item.can_resume_after)
      options_.between_chunks(slot.item.end, [this](StateWriter& out) { save(out); });
  }

  void run_steps() {
    std::vector<Slot> slots;
    slots.reserve(items_for(options_.threads));
    while (slots.size() < items_for(options_.threads)) slots.emplace_back(budget_);
    Sweepers<Sweep> sweepers(budget_);
    const auto sweep_slot = [&](Slot& slot) {
      auto sweeper = sweepers.take();
      sweep(slot, *sweeper);
      sweepers.give_back(std::move(sweeper));
    };
    work_in_order(
        options_.threads, std::span(slots), [this](Slot& slot) { return read(slot); }, sweep_slot,
        [this](Slot& slot) { glue(slot); });
  }

  ChunkSource& source_;
  MemoryBudget& budget_;
  const PipelineOptions& options_;
  std::vector<std::unique_ptr<typename Kind::Glue>> glues_;
  Reservation live_;
  std::uint64_t largest_item_ = 0;  // bytes of a chunk when it was read
  LiveMaximum maximum_;
  std::uint64_t restored_vertex_bound_ = 0;
};

}  // namespace

PipelineResult run_pipeline(ChunkSource& source, std::span<GraphSink* const> sinks, MemoryBudget& budget,
                            const PipelineOptions& options) {
  if (options.are_boxes) return Pipeline<Boxes>(source, sinks, budget, options).run();
  return Pipeline<Triangles>(source, sinks, budget, options).run();
}

}  // namespace reeb::ooc
