// A test image whose graph is known: a box with tunnels through it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace reeb::io {

struct VolumeOptions {
  std::array<std::uint64_t, 3> size{64, 64, 64};  // vertices along i, j and k; size[2] is 1 for an image of two axes
  unsigned axes = 3;
  std::uint64_t handles = 1;
  std::optional<std::uint64_t> noise_seed;  // of noise below 0.25; none: no noise
};

// The value of vertex (i, j, k) is i, with or without noise. The vertices of a tunnel have the value kNoData instead. A
// tunnel is a block of vertices in i and j that goes through all k; tunnels touch neither each other nor the border.
//
// Without the vertices of tunnels, the graph of the value has one component and a loop for each tunnel: a level between
// its ends is divided by it. So has that of x. With them, the box is solid, and every function has a tree.
class Volume {
 public:
  static constexpr float kNoData = -1000;

  // THROWS: Error{kUsage} if the grid has no room for the tunnels.
  explicit Volume(const VolumeOptions& options);

  std::uint64_t vertex_count() const;
  // The header of a NRRD file whose data follow it, as little-endian float32.
  std::string nrrd_header() const;
  // The values of row (j, k). REQUIRES: values.size() == size[0].
  void row(std::uint64_t j, std::uint64_t k, std::span<float> values) const;

 private:
  // Along i or j: cells of this many vertices, of which the middle third belongs to a tunnel.
  struct Tiling {
    std::uint64_t count = 1, pitch = 0;
    // The tile with the tunnel that has this vertex, or `count`.
    std::uint64_t tunnel_at(std::uint64_t vertex) const;
  };

  VolumeOptions options_;
  std::array<Tiling, 2> tiles_;
};

}  // namespace reeb::io
