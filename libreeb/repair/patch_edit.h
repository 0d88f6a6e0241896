// What one attempt to cut or to close does to a patch, with checks of its result.
#pragma once

#include <cstddef>
#include <cstdint>

#include "libreeb/repair/editable_patch.h"
#include "libreeb/repair/number_set.h"
#include "libreeb/repair/rim_filling.h"
#include "libreeb/repair/triangle_split.h"

namespace reeb {

// In edges: a filling of a wider rim is refined and faired.
inline constexpr std::size_t kWideRim = 10;

class PatchEdit {
 public:
  // `float32`: positions of new vertices are float32 numbers. `split`: what was done to the patch for this attempt
  // before; it is not undone.
  PatchEdit(EditablePatch& patch, bool float32, const PatchSplit* split = nullptr);

  void remove(const PatchNumbers& triangles);
  // Fills a path of edges with one triangle each. False if there is no such filling.
  bool fill(PatchNumbers path, FillWeight weight, bool refine);
  void undo();

  // Triangles that are gone, and those that are new. Of divided triangles, those count that were there before, and the
  // parts that are there now.
  std::size_t removed_count() const;
  std::size_t added_count() const;
  // All vertices of triangles that were removed or added, as a set.
  PatchNumbers touched() const;
  // The volume between the surface before and after, along its triangles' normals.
  double volume() const;
  // Whether a new triangle lies nearly on its neighbour.
  bool folds() const;
  // Whether a new triangle is flat, or meets another one but at common corners and edges.
  bool crosses() const;

 private:
  Rim rim_of(const PatchNumbers& path) const;
  std::size_t first_new() const;
  Point normal(std::uint32_t t) const;
  std::uint32_t only_at(std::uint32_t a, std::uint32_t b) const;

  EditablePatch& patch_;
  bool float32_;
  const PatchSplit* split_;
  std::size_t vertices_, triangles_;  // before
  PatchNumbers removed_;
};

}  // namespace reeb
