#include "ooc/whole_mesh/fiedler.h"

#include <Spectra/SymEigsSolver.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kRowsLimit = 200'000;
constexpr std::uint64_t kClusters = 50'000;
constexpr std::uint64_t kRowBytes = 1024;  // of the factorization, measured on surfaces
constexpr int kSmoothingSteps = 8;
constexpr std::size_t kTrianglesAtOnce = 4096;
constexpr double kWeakEdge = 1e-3;

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

// Calls visit(a, b) for the edges of all triangles. An edge of several triangles is visited for each.
template <class Visit>
void for_each_edge(IndexedMesh& mesh, const Visit& visit) {
  std::vector<VertexId> corners;
  mesh.rewind();
  while (mesh.read(corners, kTrianglesAtOnce))
    for (std::size_t t = 0; t < corners.size(); t += 3)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint64_t a = corners[t + c].value(), b = corners[t + (c + 1) % 3].value();
        if (a != b) visit(a, b);
      }
}

// The row of the matrix that a vertex belongs to.
class Rows {
 public:
  Rows(std::uint64_t vertices, std::uint64_t memory_bytes) : vertices_(vertices) {
    const std::uint64_t most = std::clamp<std::uint64_t>(memory_bytes / 4 / kRowBytes, 64, kRowsLimit);
    const std::uint64_t rows = vertices <= most ? vertices : std::min(most, kClusters);
    per_row_ = (vertices + rows - 1) / rows;
  }
  std::uint64_t count() const { return (vertices_ + per_row_ - 1) / per_row_; }
  std::uint64_t of(std::uint64_t vertex) const { return vertex / per_row_; }
  bool exact() const { return per_row_ == 1; }

 private:
  std::uint64_t vertices_, per_row_;
};

// Sums the weights of a graph's edges as they are added; compacts itself whenever their number has doubled.
class EdgeWeights {
 public:
  void add(std::uint64_t a, std::uint64_t b, double weight) {
    edges_.push_back({std::min(a, b) << 32 | std::max(a, b), weight});
    if (edges_.size() >= limit_) {
      compact();
      limit_ = std::max(limit_, 2 * edges_.size());
    }
  }
  struct Edge {
    std::uint64_t ends;
    double weight;
    int low() const { return static_cast<int>(ends >> 32); }
    int high() const { return static_cast<int>(ends & 0xffffffff); }
  };
  const std::vector<Edge>& compact() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
    std::size_t kept = 0;
    for (const Edge& edge : edges_) {
      if (kept != 0 && edges_[kept - 1].ends == edge.ends)
        edges_[kept - 1].weight += edge.weight;
      else
        edges_[kept++] = edge;
    }
    edges_.resize(kept);
    return edges_;
  }

 private:
  std::vector<Edge> edges_;
  std::size_t limit_ = std::size_t{1} << 20;
};

std::size_t find_root(std::vector<std::size_t>& parents, std::size_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

// Joins the components of the graph in a chain, in the order of their first rows.
void chain_components(EdgeWeights& weights, std::size_t rows) {
  std::vector<std::size_t> parents(rows);
  for (std::size_t i = 0; i < rows; ++i) parents[i] = i;
  for (const EdgeWeights::Edge& edge : weights.compact()) {
    const std::size_t a = find_root(parents, static_cast<std::size_t>(edge.low()));
    const std::size_t b = find_root(parents, static_cast<std::size_t>(edge.high()));
    parents[std::max(a, b)] = std::min(a, b);
  }
  std::size_t last = 0;
  for (std::size_t i = 1; i < rows; ++i)
    if (find_root(parents, i) == i) {
      weights.add(last, i, kWeakEdge);
      last = i;
    }
}

Matrix laplacian(EdgeWeights& weights, std::size_t rows) {
  std::vector<Eigen::Triplet<double>> entries;
  Vector degree = Vector::Zero(static_cast<Eigen::Index>(rows));
  for (const EdgeWeights::Edge& edge : weights.compact()) {
    entries.emplace_back(edge.high(), edge.low(), -edge.weight);
    degree[edge.low()] += edge.weight;
    degree[edge.high()] += edge.weight;
  }
  for (int i = 0; i < degree.size(); ++i) entries.emplace_back(i, i, degree[i]);
  Matrix matrix(degree.size(), degree.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// x -> (L + shift)^-1 x, from the lower half of L, as Spectra wants it. The shift makes L definite.
class InverseLaplacian {
 public:
  using Scalar = double;

  InverseLaplacian(const Matrix& lower, double shift) : size_(lower.rows()) {
    factor_.setShift(shift);
    factor_.compute(lower);
    if (factor_.info() != Eigen::Success)
      throw Error(ErrorKind::kResource, "the mesh Laplacian cannot be factored", "use --order hilbert");
  }
  Eigen::Index rows() const { return size_; }
  Eigen::Index cols() const { return size_; }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Vector>(out, size_) = factor_.solve(Eigen::Map<const Vector>(in, size_));
  }

 private:
  Eigen::Index size_;
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> factor_;
};

Vector coarse_fiedler(EdgeWeights& weights, std::size_t rows) {
  const auto size = static_cast<Eigen::Index>(rows);
  if (rows < 3) return Vector::LinSpaced(size, 0, 1);
  const Matrix lower = laplacian(weights, rows);
  // Far below the eigenvalue that is sought, which is of the order of 1 / rows^2 for a chain.
  const double shift = 1e-3 / (static_cast<double>(rows) * static_cast<double>(rows)) + 1e-12;
  InverseLaplacian inverse(lower, shift);
  Spectra::SymEigsSolver<InverseLaplacian> solver(inverse, 2, std::min<Eigen::Index>(20, size));
  // A fixed start vector instead of a random one: the same mesh always gives the same order.
  Vector start(size);
  for (Eigen::Index i = 0; i < size; ++i) start[i] = static_cast<double>(i) / static_cast<double>(size) - 0.4;
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-6);
  if (solver.info() != Spectra::CompInfo::Successful || solver.eigenvectors().cols() < 2)
    return Vector::LinSpaced(size, 0, 1);  // the order along the curve is still good
  return solver.eigenvectors().col(1);
}

struct Mean {
  double sum = 0, weight = 0;
};

// Each vertex becomes the mean of itself and the mean of its neighbours.
void smooth(IndexedMesh& mesh, VertexNumbers& values, Workspace& space) {
  PagedTable<Mean> means("spectral order", space.temp, space.budget, space.share(), Mean{});
  const auto add = [&](std::uint64_t to, double value) {
    Mean& mean = means.change(to);
    mean.sum += value;
    mean.weight += 1;
  };
  for_each_edge(mesh, [&](std::uint64_t a, std::uint64_t b) {
    const double at_a = values.get(a), at_b = values.get(b);
    add(a, at_b);
    add(b, at_a);
  });
  for (std::uint64_t v = 0; v < mesh.vertex_count(); ++v)
    if (const Mean mean = means.get(v); mean.weight > 0) values.set(v, (values.get(v) + mean.sum / mean.weight) / 2);
}

}  // namespace

VertexNumbers fiedler_vector(IndexedMesh& mesh, Workspace& space) {
  const std::uint64_t count = mesh.vertex_count();
  VertexNumbers values("spectral order", space.temp, space.budget, space.share(), 0.0);
  if (count == 0) return values;
  const Rows rows(count, space.budget.limit_bytes());
  {
    const Reservation charge = space.budget.reserve("spectral order", rows.count() * kRowBytes);
    EdgeWeights weights;
    for_each_edge(mesh, [&](std::uint64_t a, std::uint64_t b) {
      if (rows.of(a) != rows.of(b)) weights.add(rows.of(a), rows.of(b), 1);
    });
    chain_components(weights, static_cast<std::size_t>(rows.count()));
    const Vector coarse = coarse_fiedler(weights, static_cast<std::size_t>(rows.count()));
    for (std::uint64_t v = 0; v < count; ++v) values.set(v, coarse[static_cast<Eigen::Index>(rows.of(v))]);
  }
  if (!rows.exact())
    for (int step = 0; step < kSmoothingSteps; ++step) smooth(mesh, values, space);
  return values;
}

}  // namespace reeb::ooc
