// A band of triangles beside a closed curve, which a cut removes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/repair/editable_patch.h"
#include "libreeb/repair/number_set.h"

namespace reeb {

// The triangles that touch the curve on either side; nothing if it does not have two sides.
// REQUIRES: an edge joins each vertex of the curve with the next, and the last with the first.
std::optional<std::array<PatchNumbers, 2>> sides_of(const EditablePatch& patch, std::span<const std::uint32_t> curve);

// Triangles on one side of a curve. Their boundary is the curve and a rim.
class CurveBand {
 public:
  // The triangles of `side`; those of `other` never become part of it.
  CurveBand(const EditablePatch& patch, std::span<const std::uint32_t> curve, const PatchNumbers& side,
            const PatchNumbers& other);

  // Adds the triangles around it.
  void grow();
  // Adds what is pinched or enclosed, until the rim is one simple path. Returns it; empty if that fails.
  PatchNumbers close_rim();
  const PatchNumbers& triangles() const { return inside_.list(); }

 private:
  void add(std::uint32_t t);
  void add_around(std::uint32_t v);
  bool is_on_curve(std::uint32_t a, std::uint32_t b) const;
  void find_edges();
  std::vector<PatchNumbers> paths() const;
  bool enclose(const std::vector<PatchNumbers>& rims);

  const EditablePatch& patch_;
  const std::span<const std::uint32_t> curve_;
  NumberSet on_curve_, inside_, forbidden_;
  bool ok_ = true;  // false: no band can be made
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

}  // namespace reeb
