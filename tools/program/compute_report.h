// The output of a finished run: a summary for people, a report for programs (docs/CLI.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ooc/run/compute_result.h"

namespace reeb::tools {

struct RunFacts {
  std::string path, format;
  std::size_t fragments = 0;  // that were glued, the first at `path`; 0: a mesh is there
  bool is_image = false;
  std::uint64_t input_bytes = 0;
  std::uint64_t memory_budget_bytes = 0;  // 0: no limit was given
};

// A pair of this type, in words that need no textbook: "loop".
const char* feature_name(PairType type);

void print_summary(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results);

// The JSON text of schema reeb.report.v1: an object, or an array if there are several functions.
std::string report_json(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results);

}  // namespace reeb::tools
