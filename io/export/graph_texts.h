// Reeb graphs as text: rg, JSON, CSV, DOT and GraphML (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include "io/export/graph_export.h"
#include "io/text/output_buffer.h"

namespace reeb::io {

void write_rg(const GraphView& view, OutputBuffer& out);
void write_json(const GraphView& view, OutputBuffer& out);
void write_node_table(const GraphView& view, OutputBuffer& out);
void write_arc_table(const GraphView& view, OutputBuffer& out);
void write_dot(const GraphView& view, OutputBuffer& out);
void write_graphml(const GraphView& view, OutputBuffer& out);

}  // namespace reeb::io
