#include "tests/support/inputs/planted_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <sstream>
#include <utility>

#include "libreeb/containers/union_find.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

Vector sum(const Vector& a, const Vector& b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
double inner(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double norm(const Vector& a) { return std::sqrt(inner(a, a)); }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A rotation, as three rows.
using Rotation = std::array<Vector, 3>;

Rotation random_rotation(Random& random) {
  Vector x{}, y{};
  do {
    for (double& c : x) c = random.unit() - 0.5;
    for (double& c : y) c = random.unit() - 0.5;
    y = sum(y, x, -inner(x, y) / inner(x, x));
  } while (norm(x) < 0.1 || norm(y) < 0.1);
  x = {x[0] / norm(x), x[1] / norm(x), x[2] / norm(x)};
  y = {y[0] / norm(y), y[1] / norm(y), y[2] / norm(y)};
  return {x, y, cross(x, y)};
}

Vector turned(const Rotation& r, const Vector& p) { return {inner(r[0], p), inner(r[1], p), inner(r[2], p)}; }
Vector turned_back(const Rotation& r, const Vector& p) {
  return sum(sum(sum({0, 0, 0}, r[0], p[0]), r[1], p[1]), r[2], p[2]);
}

// Distances with a sign, negative inside.
double box_distance(const Vector& p, const Vector& center, const Vector& half) {
  Vector q{}, outside{};
  for (std::size_t k = 0; k < 3; ++k) {
    q[k] = std::abs(p[k] - center[k]) - half[k];
    outside[k] = std::max(q[k], 0.0);
  }
  return norm(outside) + std::min(std::max({q[0], q[1], q[2]}), 0.0);
}

double bar_distance(const Vector& p, const Planted& bar) {
  const Vector axis = sum(bar.to, bar.from, -1), d = sum(p, bar.from, -1);
  const double along = inner(d, axis) / inner(axis, axis);
  const double side = norm(sum(d, axis, -along)) - bar.radius;
  const double end = (std::abs(along - 0.5) - 0.5) * norm(axis);
  return std::max(side, end);
}

constexpr double kHalf = 28, kPillar = 7, kThickness = 4, kGap = 8;  // in cells; halves of plates and pillars

constexpr double kPlace = 18;  // of the pillars, in x and y

double solid_distance(const Vector& p, const std::vector<Planted>& planted) {
  const double middle = (kGap + kThickness) / 2;
  double d = std::min(box_distance(p, {0, 0, middle}, {kHalf, kHalf, kThickness / 2}),
                      box_distance(p, {0, 0, -middle}, {kHalf, kHalf, kThickness / 2}));
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      d = std::min(d, box_distance(p, {x * kPlace, y * kPlace, 0}, {kPillar, kPillar, middle}));
  for (const Planted& defect : planted)
    if (!defect.tunnel) d = std::min(d, bar_distance(p, defect));
  for (const Planted& defect : planted)
    if (defect.tunnel) d = std::max(d, -bar_distance(p, defect));
  return d;
}

// Places on a cross between the pillars, far from each other and from all rims.
std::vector<Planted> plant(const PlantedOptions& options, Random& random) {
  std::vector<std::pair<double, double>> places = {{0, 0}, {0, -14}, {0, 14}, {-14, 0}, {14, 0}};
  std::vector<Planted> planted;
  const std::size_t count = 1 + random.below(options.most_planted);
  for (std::size_t i = 0; i < count && !places.empty(); ++i) {
    const std::size_t at = random.below(places.size());
    const auto [x, y] = places[at];
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(at));
    Planted defect;
    defect.radius = options.least_radius + (options.most_radius - options.least_radius) * random.unit();
    defect.tunnel = random.below(2) == 0;
    // Inclined by up to 20 degrees or so, as far as there is room.
    const double lean = 0.35;
    const double side_x = lean * (2 * random.unit() - 1), side_y = lean * (2 * random.unit() - 1);
    const double low = defect.tunnel ? kGap / 2 : -kGap / 2, high = defect.tunnel ? kGap / 2 + kThickness : kGap / 2;
    const double sign = defect.tunnel && random.below(2) == 0 ? -1 : 1;
    const double reach = defect.tunnel ? 3 : 2;  // out of the wall, or into it
    const double middle = (low + high) / 2, half = (high - low) / 2 + reach;
    defect.from = {x - side_x * half, y - side_y * half, sign * (middle - half)};
    defect.to = {x + side_x * half, y + side_y * half, sign * (middle + half)};
    planted.push_back(defect);
  }
  return planted;
}

// The surface between grid points inside and outside, in tetrahedra that divide each cell alike.
class Sampler {
 public:
  Sampler(const Rotation& rotation, const Vector& shift, const std::vector<Planted>& planted, int half)
      : half_(half), side_(2 * static_cast<std::size_t>(half) + 1), values_(side_ * side_ * side_, 0) {
    const auto at = [&](double x, double y, double z) {
      return solid_distance(turned_back(rotation, sum({x, y, z}, shift)), planted);
    };
    for (int z = -half; z < half; z += kBlock)
      for (int y = -half; y < half; y += kBlock)
        for (int x = -half; x < half; x += kBlock) {
          if (std::abs(at(x + kBlock / 2, y + kBlock / 2, z + kBlock / 2)) > 0.9 * kBlock + 1) continue;
          blocks_.push_back({x, y, z});
          for_each_in(blocks_.back(), kBlock + 1, [&](int i, int j, int k) {
            double& value = values_[index(i, j, k)];
            if (value != 0) return;
            value = at(i, j, k);
            // No vertex of the surface is near a grid point, so no triangle is tiny.
            if (std::abs(value) < 0.12) value = std::copysign(0.12, value);
          });
        }
  }

  void run(PlantedMesh& mesh) {
    for (const Cell& block : blocks_)
      for_each_in(block, kBlock, [&](int x, int y, int z) {
        if (x < half_ && y < half_ && z < half_) divide(x, y, z, mesh);
      });
  }

 private:
  using Cell = std::array<int, 3>;
  static constexpr int kBlock = 8;

  template <class Visit>
  void for_each_in(const Cell& block, int size, const Visit& visit) const {
    for (int z = block[2]; z < block[2] + size && z <= half_; ++z)
      for (int y = block[1]; y < block[1] + size && y <= half_; ++y)
        for (int x = block[0]; x < block[0] + size && x <= half_; ++x) visit(x, y, z);
  }

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x + half_) +
           side_ * (static_cast<std::size_t>(y + half_) + side_ * static_cast<std::size_t>(z + half_));
  }
  double value(const Cell& c) const { return values_[index(c[0], c[1], c[2])]; }

  void divide(int x, int y, int z, PlantedMesh& mesh) {
    std::array<std::size_t, 3> axes = {0, 1, 2};
    do {
      std::array<Cell, 4> corner;
      corner[0] = {x, y, z};
      for (std::size_t k = 0; k < 3; ++k) {
        corner[k + 1] = corner[k];
        ++corner[k + 1][axes[k]];
      }
      surface_in(corner, mesh);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }

  void surface_in(const std::array<Cell, 4>& corner, PlantedMesh& mesh) {
    std::vector<Cell> in, out;
    for (const Cell& c : corner) (value(c) < 0 ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    Vector outwards{};
    for (const Cell& a : in)
      for (const Cell& b : out)
        for (std::size_t k = 0; k < 3; ++k) outwards[k] += b[k] - a[k];
    if (in.size() == 2) {
      const auto a = on(in[0], out[0], mesh), b = on(in[0], out[1], mesh), c = on(in[1], out[1], mesh),
                 d = on(in[1], out[0], mesh);
      add({a, b, c}, outwards, mesh);
      add({a, c, d}, outwards, mesh);
    } else if (in.size() == 1) {
      add({on(in[0], out[0], mesh), on(in[0], out[1], mesh), on(in[0], out[2], mesh)}, outwards, mesh);
    } else {
      add({on(in[0], out[0], mesh), on(in[1], out[0], mesh), on(in[2], out[0], mesh)}, outwards, mesh);
    }
  }

  std::uint32_t on(const Cell& a, const Cell& b, PlantedMesh& mesh) {
    const std::pair<Cell, Cell> edge = std::minmax(a, b);
    const auto [it, fresh] = vertices_.try_emplace(edge, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (fresh) {
      const double part = value(a) / (value(a) - value(b));
      Vector p{};
      for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + part * (b[k] - a[k]);
      mesh.vertices.push_back(p);
    }
    return it->second;
  }

  static void add(std::array<std::uint32_t, 3> t, const Vector& outwards, PlantedMesh& mesh) {
    const Vector& p = mesh.vertices[t[0]];
    if (inner(cross(sum(mesh.vertices[t[1]], p, -1), sum(mesh.vertices[t[2]], p, -1)), outwards) < 0)
      std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }

  int half_;
  std::size_t side_;
  std::vector<double> values_;  // 0: far from the surface
  std::vector<Cell> blocks_;    // near it
  std::map<std::pair<Cell, Cell>, std::uint32_t> vertices_;
};

}  // namespace

std::size_t component_count(const PlantedMesh& mesh) {
  UnionFind component(static_cast<std::uint32_t>(mesh.vertices.size()));
  std::size_t count = mesh.vertices.size();
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 1; k < 3; ++k)
      if (component.find(t[0]) != component.find(t[k])) {
        component.unite(t[0], t[k]);
        --count;
      }
  return count;
}

std::size_t genus(const PlantedMesh& mesh) { return (2 + mesh.triangles.size() / 2 - mesh.vertices.size()) / 2; }

PlantedMesh planted_mesh(const PlantedOptions& options) {
  Random random(options.seed);
  for (;;) {
    PlantedMesh mesh;
    mesh.planted = plant(options, random);
    mesh.genuine = 3;  // four pillars
    const Rotation rotation = random_rotation(random);
    const Vector shift = {random.unit(), random.unit(), random.unit()};
    const int half = static_cast<int>(std::ceil(std::sqrt(2 * kHalf * kHalf + 16.0 * 16.0))) + 3;
    Sampler(rotation, shift, mesh.planted, half).run(mesh);
    // The grid can miss a thin defect, and make a tiny one at an edge of the solid.
    if (component_count(mesh) != 1 || genus(mesh) != mesh.planted.size() + mesh.genuine) continue;
    for (Vector& p : mesh.vertices)
      for (double& c : p) c += options.noise * (2 * random.unit() - 1);
    for (Planted& defect : mesh.planted)
      for (Vector* end : {&defect.from, &defect.to}) *end = sum(turned(rotation, *end), shift, -1);
    if (options.inwards)
      for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  }
}

std::string to_off(const PlantedMesh& mesh) {
  std::ostringstream out;
  out.precision(9);
  out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vector& p : mesh.vertices) out << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return out.str();
}

std::string to_ply(const PlantedMesh& mesh) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto append = [&](const auto& values) {
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof values);
    std::memcpy(bytes.data() + at, &values, sizeof values);
  };
  for (const Vector& p : mesh.vertices) append(p);
  for (const auto& t : mesh.triangles) {
    bytes += '\3';
    append(t);
  }
  return bytes;
}

}  // namespace reeb::test
