// The table of defects: for people, as CSV, as JSON (docs/CLI.md).
#pragma once

#include <cstddef>
#include <ostream>
#include <span>
#include <string>

#include "ooc/census/mesh_census.h"
#include "tools/defects/find_defects.h"

namespace reeb::tools {

// A row with its rank in the whole table, from 1.
struct RankedRow {
  std::size_t rank = 0;
  const DefectRow* row = nullptr;
};

std::string defect_table(const Defects& defects, std::span<const RankedRow> rows);
void write_defect_csv(const Defects& defects, std::span<const RankedRow> rows, std::ostream& stream);
// With what else is wrong with the surface.
void write_defect_json(const Defects& defects, std::span<const RankedRow> rows, const ooc::MeshCensus& census,
                       std::ostream& stream);

}  // namespace reeb::tools
