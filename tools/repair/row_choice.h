// Which rows of the table of defects are to be repaired, and why the others are not.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/defects/find_defects.h"
#include "tools/defects/row_limits.h"

namespace reeb::tools {

// The loops in the rows of a CSV file, with their lines, and their functions in the order of the rows.
struct NamedRows {
  std::string file;
  std::map<LoopName, std::size_t> lines;
  std::vector<std::string> functions;
};
// THROWS: Error{kBadInput} for a file that is not a table of defects.
NamedRows read_named_rows(const std::string& loops);

struct RowFilter {
  RowLimits limits;
  std::optional<NamedRows> named;  // only these
  bool all = false;

  // Whether the suggested length decides.
  bool is_none() const { return !all && !limits.longest && !limits.below && !named; }
};

struct ChosenRow {
  std::size_t rank = 0;
  const DefectRow* row = nullptr;
  std::string why_not;  // empty: it is to be repaired
};

// By rank. Without a filter: the rows up to the suggested length.
// THROWS: Error{kBadInput} if one of the named rows is not a loop of this mesh.
std::vector<ChosenRow> choose_rows(const Defects& defects, const RowFilter& filter);

}  // namespace reeb::tools
