// The picture of a skeleton in the shape of its mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "io/formats/open_mesh.h"
#include "io/plot/skeleton_picture.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/plot/chosen_level.h"

namespace reeb::tools {

struct SkeletonOptions {
  LevelChoice level{};
  std::string mesh{};  // empty: the skeleton alone
  std::string format{};
  io::ImageOptions image{};
  std::optional<Point> view{};  // towards the eye; empty: the best of several
  io::SurfaceStyle surface = io::SurfaceStyle::kSolid;
  io::LineColors colors = io::LineColors::kValue;
  bool on_surface = false;  // lines pass through vertices of the mesh
  std::string temp_folder{};
  // Called while the mesh is read; `pass` is "measuring" or "drawing".
  std::function<void(const char* pass, std::uint64_t done, std::uint64_t total)> progress{};
};

// THROWS: Error{kBadInput} if the buckets of the file have no vertices of the surface.
void require_surface_points(const ooc::ReebFile& file);

// As SVG. Reads the mesh twice.
// THROWS: Error of the file and of the mesh; Error{kBadInput} if the file was computed from another mesh.
// MEMORY: that of the level, some 100 MiB for the image, and 16 bytes a vertex of the mesh up to 256 MiB; beyond that
//         vertices are in a temporary file.
std::string draw_skeleton(const ooc::ReebFile& file, const SkeletonOptions& options);

}  // namespace reeb::tools
