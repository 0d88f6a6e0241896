// Which rows of the table of defects are to be repaired, and why the others are not.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/defects/find_defects.h"

namespace reeb::tools {

struct RowFilter {
  std::optional<double> below;  // of the persistence
  bool below_is_percent = false;
  std::optional<double> longest;
  std::string loops;  // a CSV file of rows; only these
  bool all = false;
};

struct ChosenRow {
  std::size_t rank = 0;
  const DefectRow* row = nullptr;
  std::string why_not;  // empty: it is to be repaired
};

// By rank. Without a filter: the rows up to the suggested length.
// THROWS: Error{kBadInput} for a file that is no table of defects, or has a row that is not one of this mesh.
std::vector<ChosenRow> choose_rows(const Defects& defects, const RowFilter& filter);

}  // namespace reeb::tools
