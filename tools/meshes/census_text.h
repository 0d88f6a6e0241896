// What `reeb info` and its JSON say about a surface (ooc/census/mesh_census.h).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ooc/census/mesh_census.h"
#include "tools/program/progress.h"

namespace reeb::tools {

// A line for each kind of place.
void print_census(const ooc::MeshCensus& census);

// Adds the fields "components", "boundaries", "nonmanifold_edges", "nonmanifold_vertices", "degenerate", "duplicates"
// and "folded", each {"count", "places"}.
void add_defects(nlohmann::ordered_json& json, const ooc::MeshCensus& census);
// Adds "loose_edges", "euler", "closed", "orientable", "oriented", "genus" and "genus_why".
void add_topology(nlohmann::ordered_json& json, const ooc::MeshCensus& census);

// For the bar, while a census is taken.
ProgressBar::Pass pass_of(ooc::CensusProgress::Phase phase);

}  // namespace reeb::tools
