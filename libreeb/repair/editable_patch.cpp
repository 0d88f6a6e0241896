#include "libreeb/repair/editable_patch.h"

#include <algorithm>

namespace reeb {

std::uint32_t EditablePatch::add_vertex(const Vertex& vertex) {
  vertices_.push_back(vertex);
  at_.emplace_back();
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void EditablePatch::add_triangle(const Corners& corners, std::uint64_t id) {
  for (const std::uint32_t t : at_[corners[0]])
    if (has_corner(t, corners[1]) && has_corner(t, corners[2])) {
      repetitions_.emplace_back(t, id);
      return;
    }
  append({corners, id, true});
}

bool EditablePatch::lies_bare(const Line& line) const {
  return !has_edge(line.a, line.b) && std::ranges::any_of(at_[line.a], [&](std::uint32_t t) {
    return triangles_[t].id != kAdded && has_corner(t, line.b);
  });
}

std::uint32_t EditablePatch::add_new(const Corners& corners) { return append({corners, kAdded, true}); }

std::uint32_t EditablePatch::append(const Triangle& triangle) {
  const auto t = static_cast<std::uint32_t>(triangles_.size());
  triangles_.push_back(triangle);
  for (const std::uint32_t v : triangle.corners) at_[v].push_back(t);
  return t;
}

void EditablePatch::take_back(std::size_t vertices, std::size_t triangles) {
  while (triangles_.size() > triangles) {
    for (const std::uint32_t v : triangles_.back().corners) at_[v].pop_back();
    triangles_.pop_back();
  }
  vertices_.resize(vertices);
  at_.resize(vertices);
  cells_.take_back(triangles);
}

EditablePatch::State EditablePatch::state() const {
  State now{vertices_.size(), std::vector<bool>(triangles_.size())};
  for (std::size_t t = 0; t < triangles_.size(); ++t) now.there[t] = triangles_[t].there;
  return now;
}

void EditablePatch::go_back(const State& before) {
  take_back(before.vertices, before.there.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) triangles_[t].there = before.there[t];
}

const TriangleCells& EditablePatch::cells() {
  constexpr double kTrianglesWide = 2;
  if (cells_.size() == 0 && !triangles_.empty()) {
    double sum = 0;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) sum += PointBox::around(placed(t).points).longest_side();
    cells_.set_width(kTrianglesWide * sum / static_cast<double>(triangles_.size()));
  }
  while (cells_.size() < triangles_.size())
    cells_.add(PointBox::around(placed(static_cast<std::uint32_t>(cells_.size())).points));
  return cells_;
}

bool EditablePatch::is_used(std::uint32_t v) const {
  return std::ranges::any_of(at_[v], [&](std::uint32_t t) { return triangles_[t].there; });
}

bool EditablePatch::has_edge(std::uint32_t a, std::uint32_t b) const { return triangles_at_edge(a, b) != 0; }

std::size_t EditablePatch::triangles_at_edge(std::uint32_t a, std::uint32_t b) const {
  std::size_t count = 0;
  for_each_at_edge(a, b, [&](std::uint32_t) { ++count; });
  return count;
}

std::uint32_t EditablePatch::across(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
  std::uint32_t other = kNone;
  std::size_t count = 0;
  for_each_at_edge(a, b, [&](std::uint32_t u) {
    ++count;
    if (u != t) other = u;
  });
  return count == 2 ? other : kNone;
}

std::uint32_t EditablePatch::third_corner(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
  const Corners& c = triangles_[t].corners;
  return *std::ranges::find_if(c, [&](std::uint32_t v) { return v != a && v != b; });
}

bool EditablePatch::runs_along(std::uint32_t t, std::uint32_t a, std::uint32_t b) const {
  const Corners& c = triangles_[t].corners;
  for (std::size_t i = 0; i < 3; ++i)
    if (c[i] == a && c[(i + 1) % 3] == b) return true;
  return false;
}

bool EditablePatch::is_closed_fan(std::uint32_t v) const {
  std::size_t count = 0;
  std::uint32_t first = kNone;
  for_each_at(v, [&](std::uint32_t t) {
    ++count;
    first = t;
  });
  if (count < 3) return false;
  const Corners& c = triangles_[first].corners;
  const std::uint32_t start = c[0] == v ? c[1] : c[0];
  std::uint32_t t = first, at = start;
  for (std::size_t steps = 1; steps <= count; ++steps) {
    at = third_corner(t, v, at);
    if (triangles_at_edge(v, at) != 2) return false;
    t = across(t, v, at);
    if (t == first) return steps == count && at == start;
  }
  return false;
}

}  // namespace reeb
