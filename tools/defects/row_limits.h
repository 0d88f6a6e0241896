// Limits of the rows of the table of defects, as --below and --longest set them.
#pragma once

#include <optional>
#include <string>

#include "tools/defects/defect_rows.h"

namespace reeb::tools {

struct RowLimits {
  std::optional<double> below;  // of the persistence
  bool below_is_percent = false;
  std::optional<double> longest;  // of the curve

  bool has_persistence(const DefectRow& row) const {
    return !below || (below_is_percent ? row.percent : row.persistence) < *below;
  }
  bool has_length(const DefectRow& row) const { return !longest || row.length() <= *longest; }
};

// Of the texts of the two options; empty: no limit. THROWS: Error{kUsage}.
RowLimits parse_row_limits(const std::string& below, const std::string& longest);

}  // namespace reeb::tools
