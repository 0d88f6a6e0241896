#include "tools/defects/row_limits.h"

#include "tools/program/quantity.h"

namespace reeb::tools {

RowLimits parse_row_limits(const std::string& below, const std::string& longest) {
  RowLimits limits;
  if (!below.empty()) {
    limits.below = parse_threshold("--below", below, {0, 100});
    limits.below_is_percent = below.ends_with('%');
  }
  if (!longest.empty()) limits.longest = parse_length("--longest", longest);
  return limits;
}

}  // namespace reeb::tools
