#include "io/fields/laplacian.h"

#include <Spectra/SymEigsShiftSolver.h>
#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

using Index = std::int64_t;
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
using Vector = Eigen::VectorXd;
using Vectors = Eigen::MatrixXd;

// A component of fewer vertices is solved as a dense matrix.
constexpr Index kDense = 128;
// A cotangent beyond this is of a triangle that is nearly a line.
constexpr double kLargestCotangent = 1e6;
constexpr double kTolerance = 1e-11;
// What solves the equation worse than this is no eigenvector.
constexpr double kLargestResidual = 0.1;
// Eigenvalues that differ by less may be the same one.
constexpr double kSame = 1e-6;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The component with most vertices; each of its vertices has a number, the others have kNone.
struct Part {
  std::vector<std::uint32_t> number;
  Index vertices = 0;
};

Part largest_component(const WholeComplex& complex) {
  Components components = components_of(complex);
  std::vector<std::uint32_t> sizes(components.count);
  for (const std::uint32_t c : components.of_vertex) ++sizes[c];
  const auto largest = static_cast<std::uint32_t>(std::ranges::max_element(sizes) - sizes.begin());
  Part part{std::move(components.of_vertex), 0};
  for (std::uint32_t& c : part.number) c = c == largest ? static_cast<std::uint32_t>(part.vertices++) : kNone;
  return part;
}

struct Weights {
  Matrix laplacian;       // the lower triangle
  Vector masses;          // in units of areas
  int unit_exponent = 0;  // of lengths, if there are any
};

void add_edge(std::uint32_t a, std::uint32_t b, double weight, std::vector<Eigen::Triplet<double, Index>>& entries) {
  entries.emplace_back(std::max(a, b), std::min(a, b), -weight);
  entries.emplace_back(a, a, weight);
  entries.emplace_back(b, b, weight);
}

// By Heron's formula in a form that is stable for needles (W. Kahan).
double area_of(double a, double b, double c) {
  if (a < b) std::swap(a, b);
  if (b < c) std::swap(b, c);
  if (a < b) std::swap(a, b);
  const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
  return std::sqrt(std::max(0.0, product)) / 4;
}

// The cotangents of a triangle that is nearly a line all become smaller by the same factor: the form of the triangle
// stays positive.
void add_triangle(const WholeComplex& complex, const std::array<std::uint32_t, 3>& corners, const Part& part,
                  std::vector<Eigen::Triplet<double, Index>>& entries, Vector& masses) {
  std::array<double, 3> length{};  // opposite to the corner
  for (std::size_t i = 0; i < 3; ++i) length[i] = complex.length(corners[(i + 1) % 3], corners[(i + 2) % 3]);
  const double area = area_of(length[0], length[1], length[2]);
  std::array<double, 3> product{};  // twice the scalar product of the edges at the corner
  double divisor = 4 * area;
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = length[i], b = length[(i + 1) % 3], c = length[(i + 2) % 3];
    product[i] = b * b + c * c - a * a;
    divisor = std::max(divisor, std::abs(product[i]) / kLargestCotangent);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t p = part.number[corners[(i + 1) % 3]], q = part.number[corners[(i + 2) % 3]];
    if (divisor > 0) add_edge(p, q, product[i] / divisor / 2, entries);
    masses[part.number[corners[i]]] += area / 3;
  }
}

template <std::size_t N>
using Simplices = std::vector<std::array<std::uint32_t, N>>;

// Each simplex of the part once, with ascending corners.
template <std::size_t N>
void add_sorted(const Simplices<N>& from, const Part& part, Simplices<N>& to) {
  for (auto corners : from) {
    if (part.number[corners[0]] == kNone) continue;
    std::ranges::sort(corners);
    to.push_back(corners);
  }
}
template <std::size_t N>
void make_unique(Simplices<N>& simplices) {
  std::ranges::sort(simplices);
  simplices.erase(std::unique(simplices.begin(), simplices.end()), simplices.end());
}

void add_edges_of(const Simplices<3>& triangles, Simplices<2>& edges) {
  for (const auto& t : triangles)
    for (const auto& edge : {std::array{t[0], t[1]}, {t[1], t[2]}, {t[0], t[2]}}) edges.push_back(edge);
}

struct PartSimplices {
  Simplices<3> triangles;
  Simplices<2> edges;  // of surfaces: those of no triangle
};

// Repeated simplices count once. An edge that a triangle has, as of a triangle with a repeated corner, adds nothing.
PartSimplices simplices_of(const WholeComplex& complex, const Part& part) {
  PartSimplices result;
  result.triangles.reserve(complex.triangles.size());
  add_sorted(complex.triangles, part, result.triangles);
  make_unique(result.triangles);
  if (complex.edges.empty()) return result;
  Simplices<2> own, of_triangles;
  own.reserve(complex.edges.size());
  add_sorted(complex.edges, part, own);
  make_unique(own);
  of_triangles.reserve(3 * result.triangles.size());
  add_edges_of(result.triangles, of_triangles);
  make_unique(of_triangles);
  std::ranges::set_difference(own, of_triangles, std::back_inserter(result.edges));
  return result;
}

Weights weights_of(const WholeComplex& complex, const Part& part) {
  Weights weights;
  weights.masses = Vector::Zero(part.vertices);
  std::vector<Eigen::Triplet<double, Index>> entries;
  auto [triangles, edges] = simplices_of(complex, part);
  if (!complex.has_cells && edges.empty()) {
    weights.unit_exponent = complex.unit_exponent;
    entries.reserve(9 * triangles.size());
    for (const auto& corners : triangles) add_triangle(complex, corners, part, entries, weights.masses);
    if (!(weights.masses.minCoeff() > 0)) {
      const double mean = weights.masses.mean();
      if (!(mean > 0))
        throw Error(ErrorKind::kBadInput, "the triangles of the mesh have no area, so it has no Laplacian",
                    "choose another function");
      // Vertices of triangles without area.
      weights.masses = weights.masses.cwiseMax(1e-9 * mean);
    }
  } else {
    add_edges_of(triangles, edges);
    make_unique(edges);
    entries.reserve(3 * edges.size());
    for (const auto& e : edges) add_edge(part.number[e[0]], part.number[e[1]], 1, entries);
    weights.masses.setOnes();
  }
  weights.laplacian.resize(part.vertices, part.vertices);
  weights.laplacian.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

class Factors : public Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<Index>> {
 public:
  // After analyzePattern().
  std::uint64_t entries() const { return static_cast<std::uint64_t>(m_matrix.outerIndexPtr()[m_matrix.cols()]); }
};

// The inverse of a shifted matrix, on the complement of vectors that are known. The form is Spectra's.
class Inverse {
 public:
  using Scalar = double;

  Inverse(const Factors& factors, const Vectors& known, Index size) : factors_(factors), known_(known), size_(size) {}

  Index rows() const { return size_; }
  Index cols() const { return size_; }
  void set_shift(double) {}  // it is part of the factors
  void perform_op(const double* in, double* out) const {
    Vector x = Eigen::Map<const Vector>(in, size_);
    project(x);
    Vector y = factors_.solve(x);
    project(y);
    Eigen::Map<Vector>(out, size_) = y;
  }

 private:
  void project(Vector& x) const {
    if (known_.cols() != 0) x -= known_ * (known_.transpose() * x);
  }

  const Factors& factors_;
  const Vectors& known_;
  Index size_;
};

struct Pairs {
  Vectors vectors;  // columns, orthonormal, by eigenvalue
  Vector eigenvalues;
};

Pairs sorted(const Pairs& pairs) {
  std::vector<Index> order(static_cast<std::size_t>(pairs.eigenvalues.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  std::ranges::stable_sort(order, {}, [&](Index i) { return pairs.eigenvalues[i]; });
  Pairs result{Vectors(pairs.vectors.rows(), pairs.vectors.cols()), Vector(pairs.eigenvalues.size())};
  for (std::size_t i = 0; i < order.size(); ++i) {
    result.vectors.col(static_cast<Index>(i)) = pairs.vectors.col(order[i]);
    result.eigenvalues[static_cast<Index>(i)] = pairs.eigenvalues[order[i]];
  }
  return result;
}

[[noreturn]] void throw_no_convergence() {
  throw Error(ErrorKind::kBadInput, "the eigenvectors of the Laplacian do not converge",
              "the mesh may have triangles that are nearly lines; choose another function");
}

// The least `wanted` eigenpairs on the complement of `known`, by one run of Lanczos. It may miss copies of multiple
// ones.
Pairs lanczos(const Factors& factors, double shift, Index size, Index wanted, const Vectors& known) {
  Inverse inverse(factors, known, size);
  const Index basis = std::min(size - known.cols(), std::max<Index>(2 * wanted + 10, 24));
  Spectra::SymEigsShiftSolver<Inverse> solver(inverse, wanted, basis, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, kTolerance, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful) throw_no_convergence();
  return sorted({solver.eigenvectors(), solver.eigenvalues()});
}

// One step of subspace iteration: what was found on complements is as precise as the rest afterwards.
Pairs polished(const Factors& factors, const Pairs& pairs, double shift) {
  const Eigen::HouseholderQR<Vectors> basis(Vectors(factors.solve(pairs.vectors)));
  const Vectors q = basis.householderQ() * Vectors::Identity(pairs.vectors.rows(), pairs.vectors.cols());
  const Vectors small = q.transpose() * Vectors(factors.solve(q));
  const Eigen::SelfAdjointEigenSolver<Vectors> solver(small);
  return sorted({q * solver.eigenvectors(), solver.eigenvalues().cwiseInverse().array() + shift});
}

// The least `wanted` eigenpairs, with multiple ones. `shifted` is symmetric and positive definite: its lower triangle.
Pairs least_pairs(const Matrix& shifted, double shift, Index wanted, MemoryBudget& budget) {
  const Index size = shifted.rows();
  if (size < std::max(kDense, 2 * wanted + 30)) {
    // The matrix and its eigenvectors, and the columns that are transformed at a time.
    const Reservation memory = budget.reserve(
        "dense Laplacian", 8 * static_cast<std::uint64_t>(size) * static_cast<std::uint64_t>(2 * size + 64));
    const Eigen::SelfAdjointEigenSolver<Vectors> solver{Vectors(shifted)};
    return {solver.eigenvectors().leftCols(wanted), solver.eigenvalues().head(wanted).array() + shift};
  }
  Factors factors;
  factors.analyzePattern(shifted);
  // An index and a value each; and the vectors of Lanczos, of the complement and of the result.
  const std::uint64_t bytes =
      16 * factors.entries() + static_cast<std::uint64_t>(size) * 8 * static_cast<std::uint64_t>(5 * wanted + 40);
  const Reservation memory = budget.reserve("factors of the Laplacian", bytes);
  factors.factorize(shifted);
  if (factors.info() != Eigen::Success)
    throw Error(ErrorKind::kBadInput, "the Laplacian of the mesh cannot be factorized",
                "the mesh may have triangles that are nearly lines; choose another function");
  Pairs pairs = lanczos(factors, shift, size, wanted, Vectors(size, 0));
  for (;;) {
    const Pairs missed = lanczos(factors, shift, size, 1, pairs.vectors);
    const double largest = pairs.eigenvalues[wanted - 1];
    if (missed.eigenvalues[0] >= largest - kSame * std::abs(largest)) return polished(factors, pairs, shift);
    pairs.vectors.conservativeResize(Eigen::NoChange, pairs.vectors.cols() + 1);
    pairs.vectors.col(pairs.vectors.cols() - 1) = missed.vectors.col(0);
    pairs.eigenvalues.conservativeResize(pairs.eigenvalues.size() + 1);
    pairs.eigenvalues[pairs.eigenvalues.size() - 1] = missed.eigenvalues[0];
    pairs = sorted(pairs);
  }
}

}  // namespace

Eigenvector laplacian_eigenvector(const WholeComplex& complex, std::uint64_t k, MemoryBudget& budget) {
  const std::uint64_t simplices = complex.triangles.size() + complex.edges.size();
  Reservation memory = budget.reserve("components", std::uint64_t{16} * complex.vertex_count());
  const Part part = complex.vertex_count() == 0 ? Part{} : largest_component(complex);
  if (k == 0 || k >= static_cast<std::uint64_t>(part.vertices))
    throw Error(ErrorKind::kBadInput,
                "the largest component has " + count_of(static_cast<std::uint64_t>(part.vertices), "vertex") +
                    ", so there is no laplacian:" + std::to_string(k),
                "choose a K from 1 that is less than this number");
  // Triplets and sorted triangles, and the matrix twice.
  const std::uint64_t building = (24 * 9 + 12) * simplices;
  memory.resize(memory.bytes() + building + 80 * std::uint64_t{complex.vertex_count()} + 64 * simplices);
  Weights weights = weights_of(complex, part);
  memory.resize(memory.bytes() - building);

  // L u = e M u becomes M^-1/2 L M^-1/2 v = e v, with v = M^1/2 u.
  const Vector scale = weights.masses.cwiseSqrt().cwiseInverse();
  Matrix& matrix = weights.laplacian;
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (Matrix::InnerIterator it(matrix, column); it; ++it) it.valueRef() *= scale[it.row()] * scale[it.col()];
  double trace = 0;
  for (Index i = 0; i < matrix.rows(); ++i) trace += matrix.coeff(i, i);
  const double epsilon = 1e-9 * trace / static_cast<double>(matrix.rows());
  Matrix shifted = matrix;
  for (Index i = 0; i < matrix.rows(); ++i) shifted.coeffRef(i, i) += epsilon;

  const Pairs pairs = least_pairs(shifted, -epsilon, static_cast<Index>(k) + 1, budget);
  const Vector v = pairs.vectors.col(static_cast<Index>(k));
  Eigenvector result;
  result.eigenvalue = pairs.eigenvalues[static_cast<Index>(k)];
  const Vector image = matrix.selfadjointView<Eigen::Lower>() * v;
  result.residual = (image - result.eigenvalue * v).norm() / std::abs(result.eigenvalue);
  if (!(result.residual < kLargestResidual)) throw_no_convergence();
  result.eigenvalue = std::ldexp(result.eigenvalue, -2 * weights.unit_exponent);
  Vector u = v.cwiseProduct(scale);
  for (double& x : u) x = std::ldexp(x, -weights.unit_exponent);
  Index place = 0;
  u.cwiseAbs().maxCoeff(&place);
  if (u[place] < 0) u = -u;
  result.values.resize(complex.vertex_count());
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    if (part.number[i] == kNone)
      ++result.other_vertices;
    else
      result.values[i] = u[part.number[i]] + 0.0;
  }
  return result;
}

}  // namespace reeb::io
