// Reeb graphs as polylines in space: VTK XML, PLY, OBJ, glTF.
//
// The points are first the nodes, in their order, then for each arc one point per non-empty bucket, from below
// (arc_line.h). An arc is the line from its lower node through these points to its upper node.
#pragma once

#include "io/export/graph_export.h"
#include "io/text/output_buffer.h"

namespace reeb::io {

enum class VtkKind { kPolyData, kUnstructuredGrid };

void write_vtk_lines(const GraphView& view, VtkKind kind, OutputBuffer& out);
void write_ply_lines(const GraphView& view, OutputBuffer& out);
void write_obj_lines(const GraphView& view, OutputBuffer& out);
// One file with its data inside. Coordinates are float32, relative to the middle of the box.
void write_gltf_lines(const GraphView& view, OutputBuffer& out);

}  // namespace reeb::io
