#include "ooc/segmentation/surface_measures.h"

#include <algorithm>
#include <limits>

namespace reeb::ooc {
namespace {

constexpr std::size_t kTrianglesAtOnce = 4096;
constexpr std::size_t kColumns = 6;  // of equal size, or twice that for the labels

constexpr std::uint64_t kArcBytes =
    sizeof(ArcMeasures) + sizeof(std::array<double, 3>) + ArcPaths::kArcBytes + ArcChains::kArcBytes;
constexpr std::uint64_t kNodeBytes = ArcPaths::kNodeBytes + ArcChains::kWorkingNodeBytes;

}  // namespace

struct SurfaceMeasures::Corner {
  SweepKey key;
  GraphPlace place{};
  bool dropped = false;
  std::array<double, 3> at{};
};

SurfaceMeasures::SurfaceMeasures(const ReebGraph& graph, const io::TempDir& temp, MemoryBudget& budget,
                                 const MeasureOptions& options)
    : graph_(graph),
      budget_(budget),
      options_(options),
      memory_(budget.reserve("measures of arcs", graph.arc_count() * kArcBytes + graph.node_count() * kNodeBytes)),
      chains_(graph),
      paths_(graph),
      labels_("vertices", temp, budget, 2 * (options.table_bytes / kColumns), kDropped),
      values_(temp, budget, options.table_bytes / kColumns),
      x_(temp, budget, options.table_bytes / kColumns),
      y_(temp, budget, options.table_bytes / kColumns),
      z_(temp, budget, options.table_bytes / kColumns),
      crossing_("contours", temp, budget,
                {.allowance_bytes = options.sort_bytes,
                 .most_bytes = options.sort_bytes,
                 .background = options.background,
                 .poll = options.poll}) {
  measured_.arcs.resize(graph.arc_count());
  measured_.centers.resize(graph.arc_count());
}

void SurfaceMeasures::add_vertices(std::span<const Label> labels, std::span<const double> values,
                                   std::span<const std::vector<double>> coordinates) {
  labels_.write(values_.size(), labels);
  values_.append(values);
  if (coordinates.size() < 3) zeros_.resize(std::max(zeros_.size(), labels.size()));
  const auto axis = [&](std::size_t k) {
    return std::span<const double>(k < coordinates.size() ? coordinates[k] : zeros_);
  };
  const auto count = labels.size();
  x_.append(axis(0).first(count));
  y_.append(axis(1).first(count));
  z_.append(axis(2).first(count));
  for (std::size_t i = 0; i < count; ++i) {
    if (labels[i] < 0) continue;
    const auto arc = static_cast<std::size_t>(labels[i]);
    ++measured_.arcs[arc].vertices;
    measured_.arcs[arc].mean += values[i];
    for (std::size_t k = 0; k < 3; ++k) measured_.centers[arc][k] += axis(k)[i];
  }
}

SurfaceMeasures::Corner SurfaceMeasures::corner(VertexId vertex) {
  const std::uint64_t v = vertex.value();
  const Label label = labels_.get(v);
  Corner corner{.key = {values_.get(v), vertex}, .at = {x_.get(v), y_.get(v), z_.get(v)}};
  corner.dropped = label == kDropped;
  corner.place = {static_cast<std::uint32_t>(label < 0 ? -1 - label : label), label < 0};
  return corner;
}

void SurfaceMeasures::add_triangle(const Corners& vertices) {
  if (vertices[0] == vertices[1] || vertices[1] == vertices[2] || vertices[0] == vertices[2]) return;
  std::array<Corner, 3> corners{corner(vertices[0]), corner(vertices[1]), corner(vertices[2])};
  std::ranges::sort(corners, std::less<>(), &Corner::key);
  const auto& [lo, mid, hi] = corners;
  const TriangleLevels triangle({lo.key.value, lo.at}, {mid.key.value, mid.at}, {hi.key.value, hi.at});
  measured_.area += triangle.area();
  if (lo.dropped || mid.dropped || hi.dropped) {
    measured_.dropped_area += triangle.area();
    return;
  }
  levels_ = {lo.key.value, mid.key.value, hi.key.value};
  triangle_ = &triangle;
  if (levels_[0] == levels_[2]) {
    add_level_triangle(corners);
  } else if (!lo.place.is_node && !hi.place.is_node && lo.place.number == hi.place.number) {
    add_piece(lo.place.number, levels_[0], levels_[2]);
  } else {
    add_side(lo, mid);
    add_side(mid, hi);
  }
  end_part();
}

// All of it is at one level. It lies with its middle corner, or next to that.
void SurfaceMeasures::add_level_triangle(const std::array<Corner, 3>& corners) {
  for (const std::size_t c : {1u, 0u, 2u})
    if (!corners[c].place.is_node) {
      measured_.arcs[corners[c].place.number].area += triangle_->area();
      return;
    }
  if (paths_.find(NodeId(corners[0].place.number), NodeId(corners[1].place.number), path_) && !path_.empty())
    measured_.arcs[path_.back().value()].area += triangle_->area();
  else
    measured_.doubtful_area += triangle_->area();
}

// The part of the triangle between the levels of two of its corners.
void SurfaceMeasures::add_side(const Corner& lo, const Corner& hi) {
  const double bottom = lo.key.value, top = hi.key.value;
  if (!lo.place.is_node && !hi.place.is_node && lo.place.number == hi.place.number)
    return add_piece(lo.place.number, bottom, top);
  const NodeId first = lo.place.is_node ? NodeId(lo.place.number) : graph_.hi[lo.place.number];
  const NodeId last = hi.place.is_node ? NodeId(hi.place.number) : graph_.lo[hi.place.number];
  const auto value = [&](NodeId node) { return graph_.nodes[node.value()].value; };
  double from = bottom, to = top;
  if (first <= last) {
    if (!lo.place.is_node) add_piece(lo.place.number, bottom, from = value(first));
    if (!hi.place.is_node) add_piece(hi.place.number, to = value(last), top);
    if (paths_.find(first, last, path_)) {
      for (const ArcId arc : path_)
        add_piece(arc.value(), value(graph_.lo[arc.value()]), value(graph_.hi[arc.value()]));
      return;
    }
  }
  measured_.doubtful_area += triangle_->area_below(to) - triangle_->area_below(from);
}

void SurfaceMeasures::add_piece(std::uint32_t arc, double from, double to) {
  if (!(from < to)) return;
  measured_.arcs[arc].area += triangle_->area_below(to) - triangle_->area_below(from);
  const std::uint32_t chain = chains_.chain_of(ArcId(arc));
  if (part_.from < part_.to && part_.chain == chain && part_.to == from) {
    part_.to = to;
    return;
  }
  end_part();
  part_ = {chain, from, to, levels_[0], levels_[1], levels_[2], triangle_->longest_level()};
}

void SurfaceMeasures::end_part() {
  if (part_.from < part_.to) crossing_.add(part_);
  part_ = {};
}

MeasuredArcs SurfaceMeasures::finish() {
  crossing_.finish(0, options_.poll);
  ChainMeasures sweep(graph_, chains_, measured_.arcs);
  std::vector<CrossingTriangle> triangles;
  Reservation memory = budget_.reserve("contours", 0);
  while (crossing_.read(triangles, kTrianglesAtOnce)) {
    if (options_.poll) options_.poll();
    for (const CrossingTriangle& triangle : triangles) sweep.add(triangle);
    memory.resize(sweep.memory_bytes());
  }
  sweep.finish();
  const std::vector<bool> doubtful = paths_.doubtful();
  for (std::size_t a = 0; a < measured_.arcs.size(); ++a) {
    ArcMeasures& arc = measured_.arcs[a];
    if (doubtful[a]) arc.shortest_contour = std::numeric_limits<double>::quiet_NaN();
    const auto count = static_cast<double>(arc.vertices);
    if (arc.vertices == 0) {
      const double lo = graph_.nodes[graph_.lo[a].value()].value, hi = graph_.nodes[graph_.hi[a].value()].value;
      arc.mean = lo + (hi - lo) / 2;
      continue;
    }
    arc.mean /= count;
    for (double& coordinate : measured_.centers[a]) coordinate /= count;
  }
  return std::move(measured_);
}

}  // namespace reeb::ooc
