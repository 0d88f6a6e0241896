// Reeb graphs as polylines in space: VTK XML, PLY, OBJ, glTF.
//
// The points are first the nodes, in their order, then for each arc one point per non-empty bucket, from below
// (arc_line.h). An arc is the line from its lower node through these points to its upper node.
#pragma once

#include <cstdint>
#include <limits>

#include "io/export/graph_export.h"
#include "io/text/output_buffer.h"

namespace reeb::io {

// How many points a file may have: PLY numbers them by int, and glTF by uint, whose largest is reserved.
inline constexpr std::uint64_t kMostPlyPoints = std::uint64_t{1} << 31;
inline constexpr std::uint64_t kMostGltfPoints = std::numeric_limits<std::uint32_t>::max();
// THROWS: Error{kBadInput} if there are more. `format` is its name in the message.
void require_few_points(std::uint64_t points, std::uint64_t most, const char* format);

enum class VtkKind { kPolyData, kUnstructuredGrid };

void write_vtk_lines(const GraphView& view, VtkKind kind, OutputBuffer& out);
// THROWS: this and write_gltf_lines() as require_few_points().
void write_ply_lines(const GraphView& view, OutputBuffer& out);
void write_obj_lines(const GraphView& view, OutputBuffer& out);
// One file with its data inside. Coordinates are float32, relative to the middle of the box.
void write_gltf_lines(const GraphView& view, OutputBuffer& out);

}  // namespace reeb::io
