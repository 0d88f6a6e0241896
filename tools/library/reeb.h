// All of the library. The classes have names in `reeb` for users; where they live is up to the library.
#pragma once

#include "io/export/graph_export.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "libreeb/base/error.h"
#include "libreeb/engine/online_reeb.h"
#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/levels.h"
#include "libreeb/hierarchy/pairing.h"
#include "ooc/reeb_file/progressive_graph.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/library/compute.h"

namespace reeb {

using io::GraphFormat;
using io::GraphView;
using io::open_mesh;
using io::write_graph;
using ooc::GraphListener;
using ooc::Level;
using ooc::PairKeys;
using ooc::PairRow;
using ooc::ProgressiveGraph;
using ooc::ReebFile;

}  // namespace reeb
