#include "ooc/run/segment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/format/mesh_match.h"
#include "libreeb/hierarchy/cancel.h"
#include "libreeb/noise/denoise.h"
#include "libreeb/segmentation/arc_history.h"
#include "libreeb/segmentation/level_arcs.h"
#include "libreeb/segmentation/parallel_arcs.h"
#include "ooc/run/explained_error.h"
#include "ooc/run/first_stage.h"
#include "ooc/run/freed_memory.h"
#include "ooc/run/run_context.h"
#include "ooc/segmentation/arc_follower.h"

namespace reeb::ooc {
namespace {

[[noreturn]] void refuse(const ReebFile& file, const std::string& what) {
  throw Error(ErrorKind::kBadInput, what, "name the mesh that the file was computed from, or compute the file again")
      .at(file.path());
}

// Empty where it has none.
std::string name_of(const MeshInput& input) { return input.path == "-" ? std::string() : input.path; }

constexpr std::size_t kEventsAtOnce = 8192;
constexpr std::uint64_t kVerticesAtOnce = 8192;

// Of cells, only the triangles that are listed would count.
void forget_surface(MeasuredArcs& measured) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  for (ArcMeasures& arc : measured.arcs) arc.area = arc.shortest_contour = kUnknown;
  measured.area = measured.doubtful_area = measured.dropped_area = kUnknown;
}

// THROWS: Error{kBadInput} unless the level of the file is this graph.
void require_level(MemoryBudget& budget, const ReebFile& file, std::uint32_t version, const ReebGraph& graph) {
  const std::uint64_t size = std::max<std::uint64_t>(graph.node_count(), graph.arc_count());
  const Reservation memory = budget.reserve("graph of the file", ReebFile::kGraphMemoryBytes * size);
  const ReebGraph stored = file.load_graph(version);
  if (stored.nodes != graph.nodes || stored.lo != graph.lo || stored.hi != graph.hi)
    refuse(file, "this is not the graph of that mesh: its nodes or arcs differ");
}

ComputeOptions run_options(ComputeOptions options) {
  options.graph_only = true;
  options.keep_sidecar = false;
  options.buckets = 0;
  options.denoise = 0;
  options.denoise_is_share = false;
  options.resume = false;
  return options;
}

// One change of the whole graph: where its arcs and nodes are afterwards.
struct Step {
  ArcHistory history;                      // of the arcs before
  std::vector<std::uint32_t> arc_of_node;  // by node before: the arc afterwards, if it is no node then; or kDropped
  std::vector<NodeId> rank;                // by node before: the node afterwards, or none()
  Reservation memory;

  bool has(std::size_t node) const { return rank[node] != NodeId::none(); }
};

class FollowedSegmentation : public Segmentation {
 public:
  // REQUIRES: the input may not be resumed.
  FollowedSegmentation(MeshInput input, VertexFunction& function, const SegmentRequest& request)
      : file_(request.file),
        version_(request.version),
        options_(run_options(request.options)),
        output_(request.output),
        functions_{&function},
        run_(input, functions_, std::span(&output_, 1), options_) {
    run_.follower =
        std::make_unique<ArcFollower>(run_.temp, run_.budget,
                                      FollowOptions{.vertex_bound = request.vertex_bound,
                                                    .names = {name_of(input), file_.path()},
                                                    .allowance_bytes = run_.plan.segment_bytes,
                                                    .most_bytes = run_.plan.most_segment_bytes,
                                                    .background = run_.background(),
                                                    .poll = [this] { run_.resumable.check_interruption(); }});
    try {
      follow(std::move(input));
      take_steps();
      order_parallel_arcs();
    } catch (...) {
      throw_explained(run_);
    }
    rewind();
  }

  std::uint64_t vertex_bound() const override { return run_.follower->places().bound(); }
  const SegmentCounts& counts() const override { return counts_; }
  const ReebGraph& level() const override { return level_; }

  void read(std::span<ArcLabel> labels, std::span<double> values) override {
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (next_ == places_.size()) fetch();
      const VertexPlace& place = places_[next_++];
      labels[i] = label(place, vertex_++);
      values[i] = place.kind == VertexPlace::Kind::kNone ? std::numeric_limits<double>::quiet_NaN() : place.value;
    }
  }

  MeasuredArcs measure(MeshReader& mesh, const std::function<void(const MeshBatch&)>& observe) override {
    constexpr std::uint64_t kMostTableBytes = 256 << 20, kMostSortBytes = 16 << 20;
    const std::uint64_t free = run_.budget.free_bytes();
    SurfaceMeasures measures(level_, run_.temp, run_.budget,
                             {.table_bytes = std::min(free / 2, kMostTableBytes),
                              .sort_bytes = std::min(free / 8, kMostSortBytes),
                              .background = run_.background(),
                              .poll = [this] { run_.resumable.check_interruption(); }});
    std::vector<ArcLabel> labels;
    std::vector<double> values;
    // Up to this vertex, the mesh has none: they were left out of the grid.
    const auto leave_out = [&](std::uint64_t end) {
      while (vertex_ != end) {
        labels.resize(static_cast<std::size_t>(std::min<std::uint64_t>(end - vertex_, kVerticesAtOnce)));
        values.resize(labels.size());
        read(labels, values);
        if (!std::ranges::all_of(values, [](double value) { return std::isnan(value); })) throw input_changed();
        measures.add_vertices(labels, values, {});
      }
    };
    bool has_cells = false;
    rewind();
    for (MeshBatch batch; mesh.read(batch);) {
      run_.resumable.check_interruption();
      observe(batch);
      if (batch.vertex_count != 0) {
        const std::uint64_t first = batch.first_vertex.value(), bound = vertex_bound();
        if (first < vertex_ || first > bound || batch.vertex_count > bound - first) throw input_changed();
        leave_out(first);
        labels.resize(batch.vertex_count);
        values.resize(batch.vertex_count);
        read(labels, values);
        measures.add_vertices(labels, values, batch.coordinates);
      }
      has_cells = has_cells || batch.has_cells();
      const std::vector<VertexId>& corners = batch.triangles();
      for (std::size_t i = 0; i < corners.size(); i += 3)
        measures.add_triangle({corners[i], corners[i + 1], corners[i + 2]});
    }
    leave_out(vertex_bound());
    MeasuredArcs measured = measures.finish();
    if (has_cells) forget_surface(measured);
    return measured;
  }

 private:
  void rewind() {
    run_.follower->places().rewind();
    places_ = {};
    next_ = 0;
    vertex_ = 0;
  }

  void follow(MeshInput input) {
    const FileHeader& header = file_.header();
    // A run without the memory for the last pass of noise removal leaves what the first stage has not removed.
    if (header.denoise_threshold == 0 && header.denoised_pairs != 0)
      throw Error(ErrorKind::kBadInput, "its noise was removed in part, so it is not known where vertices went",
                  "compute it again with more memory, or without --denoise")
          .at(file_.path());
    const FirstStageResult first = read_mesh(run_, std::move(input));
    return_freed_memory();
    require_same_mesh(file_.path(), {header.mesh_vertices, header.mesh_triangles},
                      {first.vertices, first.simplices[2]});
    if (first.vertices != 0) {
      const ValueRange range = run_.values.range(0);
      if (range.min != header.function_min || range.max != header.function_max)
        refuse(file_, "this is not the graph of that mesh: the values of " + header.function + " have another range");
    }
    full_ = run_.follower->finish();
    level_ = std::move(full_.graph);
    if (run_.follower->places().size() != first.vertices) throw std::logic_error("some vertices are on no arc");
  }

  // From the graph of the mesh to that of the level.
  void take_steps() {
    const FileHeader& header = file_.header();
    if (header.denoise_threshold != 0)
      take_step([&](const ReebGraph& graph, ArcLog& log) {
        return reeb::denoise(graph, header.denoise_threshold, log).graph;
      });
    // A file that was cut has no full graph, but what it holds of coarser levels is compared.
    if (version_ == 0 || file_.damage() == nullptr)
      require_level(run_.budget, file_, 0, level_);
    else if (level_.node_count() != header.nodes || level_.arc_count() != header.arcs)
      refuse(file_, "this is not the graph of that mesh: the numbers of nodes or arcs differ");
    if (version_ == 0) return;
    take_step([&](const ReebGraph& graph, ArcLog& log) {
      return cancel_to_version(graph, version_, log, [&](double) { run_.resumable.check_interruption(); });
    });
    require_level(run_.budget, file_, version_, level_);
  }

  // change(graph, log) returns the changed graph.
  template <class Change>
  void take_step(const Change& change) {
    const Reservation working =
        run_.budget.reserve("hierarchy", hierarchy_bytes(level_.node_count(), level_.arc_count(), {}));
    EventLog log(run_.temp, run_.budget);
    ReebGraph after = change(level_, log);
    Step step;
    const auto& nodes = level_.nodes;
    const std::uint64_t node_bytes = (sizeof(std::uint32_t) + sizeof(NodeId)) * nodes.size();
    step.memory = run_.budget.reserve("lists of arcs", node_bytes);
    step.arc_of_node.assign(nodes.size(), ArcHistory::kDropped);
    std::size_t events = 0;
    log.read_backwards([&](const ArcEvent& event) {
      const std::uint32_t arc = step.history.undo(event);
      if (events++ % kEventsAtOnce == 0) {
        step.memory.resize(node_bytes + step.history.memory_bytes());
        run_.resumable.check_interruption();
      }
      if (event.kind != ArcEvent::Kind::kJoin && event.kind != ArcEvent::Kind::kLay) return;
      const auto node = std::lower_bound(nodes.begin(), nodes.end(), event.key);
      step.arc_of_node[static_cast<std::size_t>(node - nodes.begin())] = arc;
    });
    step.rank.assign(nodes.size(), NodeId::none());
    for (std::size_t n = 0, kept = 0; n < nodes.size() && kept < after.nodes.size(); ++n)
      if (nodes[n] == after.nodes[kept]) step.rank[n] = NodeId(static_cast<std::uint32_t>(kept++));
    step.memory.resize(node_bytes + step.history.memory_bytes());
    steps_.push_back(std::move(step));
    level_ = std::move(after);
  }

  // A level has its own order of parallel arcs; that of the full graph is known.
  void order_parallel_arcs() {
    const PlacedVertices& all = run_.follower->places();
    counts_.absent = all.bound() - all.size();
    if (steps_.empty()) {
      counts_.nodes = level_.node_count();
      counts_.on_arcs = all.size() - counts_.nodes;
      return;
    }
    order_memory_ = run_.budget.reserve("order of parallel arcs", ParallelArcs::kArcBytes * level_.arc_count());
    ParallelArcs parallel(level_);
    visit_labels([&](std::uint64_t vertex, ArcLabel label) {
      ++(label >= 0 ? counts_.on_arcs : label == kDroppedVertex ? counts_.dropped : counts_.nodes);
      if (parallel.any() && label >= 0) parallel.see(ArcId(static_cast<std::uint32_t>(label)), vertex);
    });
    counts_.dropped -= counts_.absent;
    if (parallel.any()) position_ = parallel.order();
    order_memory_.resize(position_.size() * sizeof(ArcId));
  }

  template <class Visit>
  void visit_labels(const Visit& visit) {
    PlacedVertices& all = run_.follower->places();
    all.rewind();
    std::uint64_t vertex = 0;
    for (auto places = all.read(); !places.empty(); places = all.read()) {
      run_.resumable.check_interruption();
      for (const VertexPlace& place : places) {
        visit(vertex, label(place, vertex));
        ++vertex;
      }
    }
  }

  void fetch() {
    run_.resumable.check_interruption();
    places_ = run_.follower->places().read();
    next_ = 0;
  }

  ArcLabel label(const VertexPlace& place, std::uint64_t vertex) const {
    using enum VertexPlace::Kind;
    if (place.kind == kNone) return kDroppedVertex;
    bool is_node = place.kind == kNode;
    std::uint32_t number = is_node ? place.number : full_.arc_of_number[place.number].value();
    const SweepKey key{place.value, VertexId(vertex)};
    for (const Step& step : steps_) {
      if (!is_node) {
        number = step.history.find(number, key);
      } else if (step.has(number)) {
        number = step.rank[number].value();
        continue;
      } else {
        number = step.arc_of_node[number];
        is_node = false;
      }
      if (number == ArcHistory::kDropped) return kDroppedVertex;
    }
    if (is_node) return -1 - ArcLabel{number};
    return position_.empty() ? ArcLabel{number} : ArcLabel{position_[number].value()};
  }

  const ReebFile& file_;
  const std::uint32_t version_;
  const ComputeOptions options_;
  const std::string output_;
  const std::array<VertexFunction*, 1> functions_;
  RunContext run_;
  FollowedGraph full_;  // its graph is in level_
  ReebGraph level_;     // after the steps so far
  std::vector<Step> steps_;
  Reservation order_memory_;
  std::vector<ArcId> position_;  // by arc of the level, if they are not in order
  SegmentCounts counts_;

  std::span<const VertexPlace> places_;  // the present range
  std::size_t next_ = 0;
  std::uint64_t vertex_ = 0;
};

}  // namespace

std::unique_ptr<Segmentation> segment_mesh(MeshInput input, VertexFunction& function, const SegmentRequest& request) {
  input.may_resume = false;
  return std::make_unique<FollowedSegmentation>(std::move(input), function, request);
}

}  // namespace reeb::ooc
