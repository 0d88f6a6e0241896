#include "ooc/whole_mesh/fiedler.h"

#include <Spectra/SymEigsSolver.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <optional>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/containers/union_find.h"

namespace reeb::ooc {
namespace {

constexpr std::uint64_t kRowsLimit = 200'000;
constexpr std::uint64_t kClusters = 50'000;
constexpr std::uint64_t kLeastRows = 64;
constexpr std::uint64_t kRowBytes = 1024;  // of the factorization, measured on surfaces
// For each entry of the matrix: what finding the pattern of the factors takes, and what making them does beside them.
constexpr std::uint64_t kPatternBytes = 128, kMatrixBytes = 48;
constexpr int kSmoothingSteps = 8;
constexpr std::size_t kTrianglesAtOnce = 4096;
constexpr double kWeakEdge = 1e-3;

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, Eigen::Index>;
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

// The graph whose Laplacian is factored: the edges of the mesh between rows, ranges of the same number of consecutive
// vertices. An edge has the sum of its weights.
class RowGraph {
 public:
  struct Edge {
    std::uint64_t ends;
    double weight;
    std::uint64_t low() const { return ends >> 32; }
    std::uint64_t high() const { return ends & 0xffffffff; }
  };

  RowGraph(std::uint64_t vertices, MemoryBudget& budget)
      : vertices_(vertices),
        most_edges_(std::clamp<std::uint64_t>(budget.limit_bytes() / 32 / sizeof(Edge), kLeastEdges, 1u << 20)),
        most_bytes_(budget.limit_bytes() / 4),
        memory_(budget.reserve("edges of the spectral order", most_edges_ * sizeof(Edge))) {
    const std::uint64_t most = std::clamp<std::uint64_t>(budget.limit_bytes() / 4 / kRowBytes, kLeastRows, kRowsLimit);
    const std::uint64_t rows = vertices <= most ? vertices : std::min(most, kClusters);
    per_row_ = (vertices + rows - 1) / rows;
    edges_.reserve(most_edges_);
  }

  std::uint64_t rows() const { return (vertices_ + per_row_ - 1) / per_row_; }
  std::uint64_t row_of(std::uint64_t vertex) const { return vertex / per_row_; }
  bool is_exact() const { return per_row_ == 1; }
  const std::vector<Edge>& edges() const { return edges_; }

  // Between two vertices. If there is no memory for more edges, there are fewer rows afterwards.
  void add(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t i = row_of(a), j = row_of(b);
    if (i == j) return;
    push(i, j, 1);
    if (edges_.size() < most_edges_) return;
    compact();
    while (edges_.size() > most_edges_ / 2 && !grow()) coarsen();
  }

  // Call this when all edges were added. Joins the components in a chain, in the order of their first rows.
  void finish() {
    compact();
    while (edges_.size() + rows() > most_edges_ && !grow()) coarsen();
    const auto count = static_cast<std::uint32_t>(rows());
    UnionFind components(count);
    for (const Edge& edge : edges_)
      components.unite(static_cast<std::uint32_t>(edge.low()), static_cast<std::uint32_t>(edge.high()));
    std::uint32_t last = 0;
    for (std::uint32_t i = 1; i < count; ++i)
      if (components.find(i) == i) {
        push(last, i, kWeakEdge);
        last = i;
      }
    compact();
  }

  // Makes one row of two.
  void coarsen() {
    per_row_ *= 2;
    for (Edge& edge : edges_) edge.ends = edge.low() / 2 << 32 | edge.high() / 2;
    std::erase_if(edges_, [](const Edge& edge) { return edge.low() == edge.high(); });
    compact();
  }

 private:
  static constexpr std::uint64_t kLeastEdges = 4096;  // more than twice those between 64 rows

  void push(std::uint64_t i, std::uint64_t j, double weight) {
    edges_.push_back({std::min(i, j) << 32 | std::max(i, j), weight});
  }

  void compact() {
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
    std::size_t kept = 0;
    for (const Edge& edge : edges_) {
      if (kept != 0 && edges_[kept - 1].ends == edge.ends)
        edges_[kept - 1].weight += edge.weight;
      else
        edges_[kept++] = edge;
    }
    edges_.resize(kept);
  }

  bool grow() {
    const std::uint64_t bytes = 3 * most_edges_ * sizeof(Edge);  // while the edges move to the larger place
    if (bytes > most_bytes_ || !memory_.try_resize(bytes)) return false;
    most_edges_ *= 2;
    edges_.reserve(most_edges_);
    memory_.resize(most_edges_ * sizeof(Edge));
    return true;
  }

  std::uint64_t vertices_, per_row_ = 1, most_edges_;
  std::uint64_t most_bytes_;
  Reservation memory_;
  std::vector<Edge> edges_;
};

Matrix laplacian(const RowGraph& graph) {
  std::vector<Eigen::Triplet<double, Eigen::Index>> entries;
  entries.reserve(graph.edges().size() + graph.rows());
  Vector degree = Vector::Zero(static_cast<Eigen::Index>(graph.rows()));
  for (const RowGraph::Edge& edge : graph.edges()) {
    const auto low = static_cast<Eigen::Index>(edge.low()), high = static_cast<Eigen::Index>(edge.high());
    entries.emplace_back(high, low, -edge.weight);
    degree[low] += edge.weight;
    degree[high] += edge.weight;
  }
  for (Eigen::Index i = 0; i < degree.size(); ++i) entries.emplace_back(i, i, degree[i]);
  Matrix matrix(degree.size(), degree.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// Factors whose size is known before there is memory for them. analyzePattern() would take the memory at once.
class RowFactors : public Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<Eigen::Index>> {
 public:
  // Orders the rows, and counts the entries of the factors below the diagonal; more than `most` are not counted. An
  // index and a value each.
  std::uint64_t count_entries(const Matrix& lower, std::uint64_t most) {
    const Eigen::Index size = lower.cols();
    permuted_.resize(size, size);
    ordering(lower, ordered_, permuted_);
    // By the elimination tree: a row of the factor has the paths from its entries up to it.
    std::vector<Eigen::Index> parent(static_cast<std::size_t>(size), -1), seen(static_cast<std::size_t>(size), -1);
    std::uint64_t count = 0;
    for (Eigen::Index row = 0; row < size && count <= most; ++row)
      for (Matrix::InnerIterator it(*ordered_, row); it; ++it)
        for (auto i = static_cast<std::size_t>(it.index()); static_cast<Eigen::Index>(i) < row && seen[i] != row;
             i = static_cast<std::size_t>(parent[i])) {
          if (parent[i] < 0) parent[i] = row;
          seen[i] = row;
          ++count;
        }
    return count;
  }

  // Call this before factorize().
  void make_room() {
    analyzePattern_preordered(*ordered_, true);
    permuted_ = Matrix();
  }

 private:
  const Matrix* ordered_ = nullptr;
  Matrix permuted_;
};

// x -> (L + shift)^-1 x, as Spectra wants it.
class InverseLaplacian {
 public:
  using Scalar = double;

  explicit InverseLaplacian(const RowFactors& factors) : factors_(factors) {}
  Eigen::Index rows() const { return factors_.rows(); }
  Eigen::Index cols() const { return factors_.cols(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Vector>(out, rows()) = factors_.solve(Eigen::Map<const Vector>(in, rows()));
  }

 private:
  const RowFactors& factors_;
};

// The shift makes the matrix definite. False if it has no factors with any shift, as with infinite weights.
bool factorize(const Matrix& lower, RowFactors& factors) {
  const auto rows = static_cast<double>(lower.rows());
  double largest = 0;
  for (Eigen::Index i = 0; i < lower.rows(); ++i) largest = std::max(largest, lower.coeff(i, i));
  // Far below the eigenvalue that is sought, which is of the order of 1 / rows^2 for a chain. It is lost in the
  // rounding of rows with many edges, so it becomes larger then.
  for (double shift = 1e-3 / (rows * rows) + 1e-12; shift <= largest + 1; shift *= 1000) {
    factors.setShift(shift);
    factors.factorize(lower);
    if (factors.info() == Eigen::Success) return true;
  }
  return false;
}

// Nothing if the factors do not fit three eighths of the budget. The rest is for edges, tables of vertices and the
// process.
std::optional<Vector> coarse_fiedler(const RowGraph& graph, MemoryBudget& budget) {
  const auto size = static_cast<Eigen::Index>(graph.rows());
  // The order along the curve is good, too.
  const auto as_they_are = [size] { return Vector::LinSpaced(size, 0, 1); };
  if (size < 3) return as_they_are();
  Reservation memory = budget.try_reserve("spectral order", 0);
  const auto fits = [&](std::uint64_t bytes) {
    return bytes <= budget.limit_bytes() / 8 * 3 && memory.try_resize(bytes);
  };
  const std::uint64_t entries = graph.edges().size() + graph.rows();
  if (!fits(kPatternBytes * entries)) return {};
  const Matrix lower = laplacian(graph);
  RowFactors factors;
  constexpr std::uint64_t kVectors = 32;  // of Lanczos
  constexpr std::uint64_t kFactorBytes = sizeof(Eigen::Index) + sizeof(double);
  const std::uint64_t in_factors = factors.count_entries(lower, budget.limit_bytes() / kFactorBytes);
  if (!fits(kMatrixBytes * entries + kFactorBytes * in_factors + kVectors * sizeof(double) * graph.rows())) return {};
  factors.make_room();
  if (!factorize(lower, factors)) return as_they_are();
  InverseLaplacian inverse(factors);
  Spectra::SymEigsSolver<InverseLaplacian> solver(inverse, 2, std::min<Eigen::Index>(20, size));
  // A fixed start vector instead of a random one: the same mesh always gives the same order.
  Vector start(size);
  for (Eigen::Index i = 0; i < size; ++i) start[i] = static_cast<double>(i) / static_cast<double>(size) - 0.4;
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestMagn, 300, 1e-6);
  if (solver.info() != Spectra::CompInfo::Successful || solver.eigenvectors().cols() < 2) return as_they_are();
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
  bool is_exact = false;
  {
    RowGraph graph(count, space.budget);
    for_each_edge(mesh, [&](std::uint64_t a, std::uint64_t b) { graph.add(a, b); });
    graph.finish();
    std::optional<Vector> coarse;
    while (!(coarse = coarse_fiedler(graph, space.budget))) {
      if (graph.rows() <= kLeastRows)
        throw Error(ErrorKind::kResource, "the spectral order needs more memory", "allow more, or use --order hilbert")
            .because(ErrorCause::kMemory);
      graph.coarsen();
    }
    for (std::uint64_t v = 0; v < count; ++v) values.set(v, (*coarse)[static_cast<Eigen::Index>(graph.row_of(v))]);
    is_exact = graph.is_exact();
  }
  if (!is_exact)
    for (int step = 0; step < kSmoothingSteps; ++step) smooth(mesh, values, space);
  return values;
}

}  // namespace reeb::ooc
