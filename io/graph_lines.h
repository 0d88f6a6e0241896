// Reeb graphs as polylines in space: VTK XML, PLY, OBJ.
//
// Points are the nodes, in their order, then the non-empty buckets of each arc from below; an arc
// is the line from its lower node through its buckets to its upper node.
#pragma once

#include "io/graph_export.h"
#include "io/text_sink.h"

namespace reeb::io {

enum class VtkKind { kPolyData, kUnstructuredGrid };

void write_vtk_lines(const GraphView& view, VtkKind kind, TextSink& out);
void write_ply_lines(const GraphView& view, TextSink& out);
void write_obj_lines(const GraphView& view, TextSink& out);

}  // namespace reeb::io
