#include "ooc/patches/far_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "libreeb/base/vector3.h"
#include "libreeb/repair/triangle_cells.h"
#include "ooc/patches/near_balls.h"

namespace reeb::ooc {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Cells of a coarse grid that balls touch: most triangles touch none of them.
class TouchedCells {
 public:
  explicit TouchedCells(std::span<const PatchBall> balls) : touched_(kSide * kSide * kSide, false) {
    for (const PatchBall& place : balls) all_.add(box_of(place.ball));
    for (const PatchBall& place : balls)
      visit(box_of(place.ball), [&](std::size_t cell) {
        touched_[cell] = true;
        return true;
      });
  }

  bool meet(const PointBox& box) const {
    if (!all_.meets(box)) return false;
    bool found = false;
    visit(box, [&](std::size_t cell) {
      found = touched_[cell];
      return !found;
    });
    return found;
  }

 private:
  static constexpr std::size_t kSide = 64;

  static PointBox box_of(const Ball& ball) {
    const Point& c = ball.center;
    const double r = ball.radius;
    return {{c[0] - r, c[1] - r, c[2] - r}, {c[0] + r, c[1] + r, c[2] + r}};
  }
  std::size_t place(double x, std::size_t k) const {
    const double share = (x - all_.low[k]) / (all_.high[k] - all_.low[k]) * kSide;
    return share > 0 ? static_cast<std::size_t>(std::min(share, kSide - 1.0)) : 0;
  }
  // While look(cell) returns true.
  template <class Look>
  void visit(const PointBox& box, const Look& look) const {
    std::array<std::size_t, 3> from{}, to{};
    for (std::size_t k = 0; k < 3; ++k) {
      from[k] = place(box.low[k], k);
      to[k] = place(box.high[k], k);
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z)
      for (std::size_t y = from[1]; y <= to[1]; ++y)
        for (std::size_t x = from[0]; x <= to[0]; ++x)
          if (!look((z * kSide + y) * kSide + x)) return;
  }

  PointBox all_{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  std::vector<bool> touched_;
};

class Finder {
 public:
  Finder(std::span<const PatchBall> balls, std::size_t patches, MemoryBudget& budget)
      : balls_(balls), memory_(budget.reserve("large triangles near patches", 250 * balls.size())), cells_(balls) {
    std::vector<Ball> plain;
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
      plain.push_back(balls[i].ball);
      near_.add(balls[i].ball, i);
      least_ = std::min(least_, balls[i].least);
    }
    grid_.emplace(plain);
    found_.resize(patches);
  }

  void look_at(const std::array<VertexId, 3>& corners, const std::array<Point, 3>& points) {
    const PointBox box = PointBox::around(points);
    const double side = box.longest_side();
    if (!(side > least_) || !cells_.meet(box)) return;
    Ball around;
    for (std::size_t k = 0; k < 3; ++k) around.center[k] = box.low[k] / 2 + box.high[k] / 2;
    around.radius = distance(box.low, box.high) / 2;
    const std::vector<std::uint32_t> candidates = near_.meeting(around);
    if (candidates.empty()) return;
    const std::uint32_t home = patch_with(points);
    std::vector<std::uint32_t> patches;
    for (const std::uint32_t i : candidates) {
      const PatchBall& place = balls_[i];
      if (side > place.least && place.patch != home && comes_near(place.ball, box, points))
        patches.push_back(place.patch);
    }
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    for (const std::uint32_t patch : patches) found_[patch].push_back({corners, points});
    count_ += patches.size();
  }

  void note_memory() { memory_.resize(250 * balls_.size() + 100 * count_); }

  FarTriangles result() {
    memory_.resize(100 * count_);
    return {std::move(found_), std::move(memory_)};
  }

 private:
  // The patch whose balls contain all corners.
  std::uint32_t patch_with(const std::array<Point, 3>& points) const {
    std::uint32_t patch = BallGrid::kNone;
    for (const Point& point : points) {
      const std::uint32_t ball = grid_->find(point);
      if (ball == BallGrid::kNone || (patch != BallGrid::kNone && balls_[ball].patch != patch)) return BallGrid::kNone;
      patch = balls_[ball].patch;
    }
    return patch;
  }

  // Whether the ball meets the box and the plane of the triangle.
  static bool comes_near(const Ball& ball, const PointBox& box, const std::array<Point, 3>& points) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = std::max({0.0, box.low[k] - ball.center[k], ball.center[k] - box.high[k]});
      sum += off * off;
    }
    if (sum > ball.radius * ball.radius) return false;
    const Point normal = cross(points[1] - points[0], points[2] - points[0]);
    constexpr double kRoundedOff = 1.001;
    return std::abs(dot(normal, ball.center - points[0])) <= kRoundedOff * ball.radius * std::sqrt(dot(normal, normal));
  }

  const std::span<const PatchBall> balls_;
  Reservation memory_;
  TouchedCells cells_;
  NearBalls near_;
  std::optional<BallGrid> grid_;
  double least_ = kFar;
  std::vector<std::vector<FarTriangle>> found_;
  std::uint64_t count_ = 0;
};

}  // namespace

FarTriangles find_far_triangles(IndexedMesh& mesh, std::span<const PatchBall> balls, std::size_t patches,
                                MemoryBudget& budget, const std::function<void(const IndexedMesh&)>& progress) {
  constexpr std::size_t kTogether = 16384;
  Finder finder(balls, patches, budget);
  std::vector<unsigned> columns = {0, 1, 2};
  columns.resize(std::min<std::size_t>(3, mesh.column_count()));
  std::vector<VertexId> corners;
  std::vector<double> values;
  mesh.rewind();
  while (mesh.read(corners, kTogether)) {
    const std::size_t n = corners.size();
    values.resize(columns.size() * n);
    mesh.gather(corners, columns, values);
    for (std::size_t i = 0; i < n; i += 3) {
      std::array<Point, 3> points{};
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = 0; k < columns.size(); ++k) points[c][k] = values[k * n + i + c];
      finder.look_at({corners[i], corners[i + 1], corners[i + 2]}, points);
    }
    finder.note_memory();
    progress(mesh);
  }
  return finder.result();
}

}  // namespace reeb::ooc
