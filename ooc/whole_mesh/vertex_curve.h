// The places of vertices along a curve through a mesh. Vertices that are near on the curve are near in the mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace reeb::ooc {

// A box of up to three axes; min > max before the first value.
struct CurveBox {
  // REQUIRES: at most three axes.
  explicit CurveBox(std::size_t count);
  // Values of consecutive vertices along one axis. NaN does not count.
  void add(std::size_t axis, std::span<const double> values);

  std::size_t axes;
  std::array<double, 3> low, high;
};

// A Hilbert curve through the box; or one for each of many slabs across its longest axis, one after the other. Then
// whatever follows the curve has a front of about one slab.
class VertexCurve {
 public:
  VertexCurve(const CurveBox& box, std::uint64_t slabs);

  // The number of slabs, for a surface of so many vertices, of which each is about as thick as a hundred edges.
  static std::uint64_t slab_count(std::uint64_t vertices);

  // The places of vertices, given all their values along the first axis, then all along the second, and so on.
  // REQUIRES: at least as many values as axes times places.
  void places(std::span<const double> values, std::span<std::uint64_t> places) const;

 private:
  CurveBox box_;
  double half_size_ = 0;     // of the longest axis
  std::size_t longest_ = 0;  // axis
  std::uint64_t slabs_;
};

}  // namespace reeb::ooc
