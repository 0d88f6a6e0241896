#include "ooc/whole_mesh/mesh_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace reeb::ooc {
namespace {

// Of a piece, a batch at a time is read and looked up, each twice as long as the one before. So a mesh in random order,
// whose pieces have a triangle or two, costs a few look-ups a piece: each of them reads a window of the file.
constexpr std::size_t kFirstBatch = 8, kLongestBatch = 512;
constexpr std::size_t kTrianglesPerEdge = 32;  // of which one is looked up
// In edges. Tiles that are nearer than this are as good as one piece.
constexpr double kFar = 16, kLarge = 256;
// On average, a piece must have some triangles, or sorting is cheaper than visiting pieces.
constexpr std::uint64_t kLeastTriangles = 24, kFirstPieces = 64;
// To hold a piece, and to order pieces.
constexpr std::uint64_t kPieceBytes = sizeof(MeshPiece) + 8;

class Box {
 public:
  void clear() {
    low_.fill(std::numeric_limits<double>::infinity());
    high_.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const std::array<double, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], p[k]);
      high_[k] = std::max(high_[k], p[k]);
    }
  }
  // Whether a point is near the box, and the box stays small with it.
  bool suits(const std::array<double, 3>& p, double edge) const {
    double distance = 0, side = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      distance = std::max({distance, low_[k] - p[k], p[k] - high_[k]});
      side = std::max(side, std::max(high_[k], p[k]) - std::min(low_[k], p[k]));
    }
    return distance <= kFar * edge && side <= kLarge * edge;
  }
  double side(std::size_t axis) const { return high_[axis] - low_[axis]; }
  std::array<float, 3> centre() const {
    std::array<float, 3> result{};
    constexpr double kMost = 1e38;
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = static_cast<float>(std::clamp(low_[k] / 2 + high_[k] / 2, -kMost, kMost));
    return result;
  }

 private:
  std::array<double, 3> low_, high_;
};

class Cutter {
 public:
  Cutter(IndexedMesh& mesh, MemoryBudget& budget, const PieceOptions& options)
      : mesh_(mesh), options_(options), axes_(std::min({options.coordinates, mesh.column_count(), 3u})) {
    std::iota(axes_.begin(), axes_.end(), 0u);
    result_.memory = budget.reserve("pieces of the mesh", 0);
    box_.clear();
  }

  std::optional<MeshPieces> run() {
    if (axes_.empty()) return std::nullopt;
    mesh_.rewind();
    while (const auto place = mesh_.place()) {
      const std::size_t room = options_.most_triangles - piece_.triangles;
      const std::size_t batch = std::clamp<std::size_t>(piece_.triangles, kFirstBatch, kLongestBatch);
      if (!mesh_.read(corners_, std::min(batch, room))) return finish();
      look_up();
      if (!take(*place)) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  // The positions of first corners, then those of some second corners.
  void look_up() {
    ids_.clear();
    for (std::size_t c = 0; c < corners_.size(); c += 3) ids_.push_back(corners_[c]);
    for (std::size_t c = 0; c < corners_.size(); c += 3 * kTrianglesPerEdge) ids_.push_back(corners_[c + 1]);
    values_.resize(axes_.size() * ids_.size());
    mesh_.gather(ids_, axes_, values_);
  }

  std::array<double, 3> position(std::size_t i) const {
    std::array<double, 3> p{};
    for (std::size_t k = 0; k < axes_.size(); ++k) p[k] = values_[k * ids_.size() + i];
    return p;
  }

  // Adds the triangles that were read, from `place` on, up to the end of the piece. False if pieces are too many.
  bool take(const MeshPlace& place) {
    const std::size_t count = corners_.size() / 3;
    for (std::size_t t = 0; t < count; ++t) {
      const auto p = position(t);
      if (t % kTrianglesPerEdge == 0) follow_edge(p, position(count + t / kTrianglesPerEdge));
      if (piece_.triangles == 0)
        piece_.place = place;
      else if (edge_ > 0 && !box_.suits(p, edge_))
        return end_piece() && start_after(place, t);
      box_.add(p);
      ++piece_.triangles;
    }
    return piece_.triangles < options_.most_triangles || end_piece();
  }

  // Reads the first t triangles after the place again, so that the mesh goes on with the next one.
  bool start_after(const MeshPlace& place, std::size_t t) {
    mesh_.seek(place);
    for (std::size_t passed = 0; passed < t && mesh_.read(corners_, t - passed);) passed += corners_.size() / 3;
    return true;
  }

  // The running median of the lengths of edges.
  void follow_edge(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    constexpr double kStep = 1.05;
    double length = 0;
    for (std::size_t k = 0; k < 3; ++k) length = std::max(length, std::abs(a[k] - b[k]));
    if (length == 0 || !std::isfinite(length)) return;
    if (edge_ == 0)
      edge_ = length;
    else
      edge_ *= length > edge_ ? kStep : 1 / kStep;
  }

  bool end_piece() {
    std::vector<MeshPiece>& pieces = result_.pieces;
    triangles_ += piece_.triangles;
    if (pieces.size() >= options_.most_pieces || pieces.size() > kFirstPieces + triangles_ / kLeastTriangles)
      return false;
    if (pieces.size() == pieces.capacity()) {
      const std::size_t capacity = std::max<std::size_t>(1024, pieces.size() + pieces.size() / 2);
      result_.memory.resize(kPieceBytes * (capacity + pieces.size()));
      pieces.reserve(capacity);
      result_.memory.resize(kPieceBytes * capacity);
    }
    piece_.centre = box_.centre();
    for (std::size_t k = 0; k < 3; ++k) result_.sides[k] += box_.side(k) * piece_.triangles;
    pieces.push_back(piece_);
    piece_ = {};
    box_.clear();
    if (options_.progress) options_.progress(mesh_.bytes_read());
    return true;
  }

  std::optional<MeshPieces> finish() {
    if (piece_.triangles != 0 && !end_piece()) return std::nullopt;
    for (double& side : result_.sides) side /= static_cast<double>(std::max<std::uint64_t>(triangles_, 1));
    result_.warnings = mesh_.warnings();
    return std::move(result_);
  }

  IndexedMesh& mesh_;
  const PieceOptions& options_;
  std::vector<unsigned> axes_;
  MeshPieces result_;
  MeshPiece piece_{};  // the one that is being read
  Box box_;
  double edge_ = 0;
  std::uint64_t triangles_ = 0;
  std::vector<VertexId> corners_, ids_;
  std::vector<double> values_;
};

}  // namespace

std::optional<MeshPieces> cut_into_pieces(IndexedMesh& mesh, MemoryBudget& budget, const PieceOptions& options) {
  return Cutter(mesh, budget, options).run();
}

}  // namespace reeb::ooc
