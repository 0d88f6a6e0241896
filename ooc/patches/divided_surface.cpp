#include "ooc/patches/divided_surface.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

namespace reeb::ooc {
namespace {

constexpr const char* kOwner = "patches of loops";

std::vector<Ball> plain(std::span<const GroupedBall> balls) {
  std::vector<Ball> result;
  result.reserve(balls.size());
  for (const GroupedBall& grouped : balls) result.push_back(grouped.ball);
  return result;
}

}  // namespace

DividedSurface::DividedSurface(std::span<const GroupedBall> balls, std::size_t groups, std::size_t functions,
                               const io::TempDir& temp, MemoryBudget& budget)
    : budget_(&budget),
      functions_(functions),
      vertices_(kOwner, temp, budget, groups),
      triangles_(kOwner, temp, budget, groups),
      memory_(budget.reserve(kOwner, 100 * balls.size())) {
  grid_.emplace(plain(balls));
  group_of_ball_.reserve(balls.size());
  ball_is_measured_.reserve(balls.size());
  for (const GroupedBall& grouped : balls) {
    group_of_ball_.push_back(grouped.group);
    ball_is_measured_.push_back(grouped.measured ? 1 : 0);
  }
  for (std::uint32_t g = 0; g < groups; ++g) sets_.push_back({g});
}

DividedSurface::Place DividedSurface::place_of(const Point& point) {
  Place place;
  at_point_.clear();
  grid_->visit(point, [&](std::uint32_t ball) {
    const std::uint32_t group = group_of_ball_[ball];
    place.measured = place.measured || ball_is_measured_[ball] != 0;
    if (place.groups == BallGrid::kNone) place.groups = group;
    if (group != place.groups) at_point_.push_back(group);
    return true;
  });
  if (at_point_.empty()) return place;
  at_point_.push_back(place.groups);
  std::sort(at_point_.begin(), at_point_.end());
  at_point_.erase(std::unique(at_point_.begin(), at_point_.end()), at_point_.end());
  const auto [it, is_new] = several_.try_emplace(at_point_, static_cast<std::uint32_t>(sets_.size()));
  if (is_new) sets_.push_back(at_point_);
  place.groups = it->second;
  return place;
}

void DividedSurface::add(const MeshBatch& batch, std::span<const std::vector<double>> values) {
  for (std::size_t i = 0; i < batch.vertex_count; ++i) {
    const Point point = batch.position(i);
    const auto [groups, is_measured] = place_of(point);
    if (groups == BallGrid::kNone) continue;
    const VertexId vertex(batch.first_vertex.value() + i);
    for (const std::uint32_t group : sets_[groups]) {
      vertices_.append(group, set_.size());
      vertices_.append(group, vertex.value());
      for (const double x : point) vertices_.append(group, std::bit_cast<std::uint64_t>(x));
      for (std::size_t f = 0; f < functions_; ++f) vertices_.append(group, std::bit_cast<std::uint64_t>(values[f][i]));
    }
    if (is_measured) {
      measured_.add(VertexId(set_.size()));
      measured_positions_.push_back(point);
    }
    set_.add(vertex);
    groups_of_.push_back(groups);
  }
  for (std::size_t k = 2; k < batch.simplices.size(); ++k) {
    const auto& corners = batch.simplices[k];
    for (std::size_t s = 0; s < corners.size(); s += k + 1)
      for (std::size_t a = 0; a + 2 <= k; ++a)
        for (std::size_t b = a + 1; b + 1 <= k; ++b)
          for (std::size_t c = b + 1; c <= k; ++c) add_triangle(corners[s + a], corners[s + b], corners[s + c]);
  }
  const std::uint64_t sets = 200 * several_.size();
  memory_.resize(grid_->memory_bytes() + 5 * group_of_ball_.size() + set_.memory_bytes() + measured_.memory_bytes() +
                 groups_of_.memory_bytes() + sizeof(Point) * measured_positions_.capacity() + sets);
}

void DividedSurface::add_triangle(VertexId a, VertexId b, VertexId c) {
  const Triangle triangle{{set_.find(a), set_.find(b), set_.find(c)}};
  const auto& [x, y, z] = triangle.corners;
  // Most triangles of a large mesh are in no ball.
  if ((x & y & z) == VertexSet::kNone || a == b || b == c || a == c) return;
  measure(triangle);
  std::uint32_t first = BallGrid::kNone;
  bool all_alike = true;
  for (const std::uint32_t v : triangle.corners) {
    if (v == VertexSet::kNone) continue;
    if (first == BallGrid::kNone) first = groups_of_[v];
    all_alike = all_alike && groups_of_[v] == first;
  }
  if (all_alike) {
    for (const std::uint32_t group : sets_[first]) triangles_.append(group, triangle);
    return;
  }
  Groups groups, more;
  for (const std::uint32_t v : triangle.corners) {
    if (v == VertexSet::kNone) continue;
    more.clear();
    std::ranges::set_union(groups, sets_[groups_of_[v]], std::back_inserter(more));
    groups.swap(more);
  }
  for (const std::uint32_t group : groups) triangles_.append(group, triangle);
}

void DividedSurface::measure(const Triangle& triangle) {
  std::array<Point, 3> at{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (triangle.corners[k] == VertexSet::kNone) return;
    const std::uint32_t i = measured_.find(VertexId(triangle.corners[k]));
    if (i == VertexSet::kNone) return;
    at[k] = measured_positions_[i];
  }
  measured_length_ += distance(at[0], at[1]) + distance(at[1], at[2]) + distance(at[2], at[0]);
  measured_edges_ += 3;
}

void DividedSurface::finish() {
  grid_.reset();
  std::vector<std::uint32_t>().swap(group_of_ball_);
  groups_of_ = {};
  std::vector<Groups>().swap(sets_);
  several_.clear();
  std::vector<std::uint8_t>().swap(ball_is_measured_);
  std::vector<Point>().swap(measured_positions_);
  set_ = {};
  measured_ = {};
  memory_.resize(0);
}

CollectedSurface DividedSurface::surface(std::uint32_t group) {
  const std::size_t words = 5 + functions_;
  const auto vertex_count = static_cast<std::size_t>(vertices_.count(group) / words);
  const auto triangle_count = static_cast<std::size_t>(triangles_.count(group));
  SurfaceContent content;
  content.memory = budget_->reserve(kOwner, CollectedSurface::memory_bytes(vertex_count, triangle_count, functions_));
  content.vertices.reserve(vertex_count);
  content.positions.reserve(vertex_count);
  content.values.resize(functions_);
  for (auto& values : content.values) values.reserve(vertex_count);
  content.whole.assign(vertex_count, 1);
  content.triangles.reserve(triangle_count);
  VertexSet numbers;  // in the balls of all groups
  vertices_.rewind(group);
  const auto number = [&] { return std::bit_cast<double>(vertices_.next(group)); };
  for (std::size_t i = 0; i < vertex_count; ++i) {
    numbers.add(VertexId(vertices_.next(group)));
    content.vertices.emplace_back(vertices_.next(group));
    Point& point = content.positions.emplace_back();
    for (double& x : point) x = number();
    for (auto& values : content.values) values.push_back(number());
  }
  triangles_.rewind(group);
  for (std::size_t i = 0; i < triangle_count; ++i) {
    std::array<std::uint32_t, 3> corners = triangles_.next(group).corners;
    bool all = true;
    for (std::uint32_t& v : corners) {
      if (v != VertexSet::kNone) v = numbers.find(VertexId(v));
      all = all && v != VertexSet::kNone;
    }
    if (all) content.triangles.push_back(corners);
    for (const std::uint32_t v : corners)
      if (!all && v != VertexSet::kNone) content.whole[v] = 0;
  }
  return CollectedSurface(std::move(content));
}

}  // namespace reeb::ooc
