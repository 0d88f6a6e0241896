// A Reeb graph as samples of trees, for programs that read neurons (SWC).
//
// A sample is a line `id type x y z radius parent`; ids count from 1, a parent comes before its children, and the
// parent of a root is -1. Each component is a tree, whose root is its lowest node. An arc that closes a loop ends in a
// sample at the place of its node, which that node's own samples do not continue. Radii that are not known are 0.
#pragma once

#include "io/export/graph_export.h"
#include "io/text/output_buffer.h"

namespace reeb::io {

// MEMORY: 36 bytes per node, 16 per arc and 8 per point.
void write_swc(const GraphView& view, OutputBuffer& out);

}  // namespace reeb::io
