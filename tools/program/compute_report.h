// What a finished run says: a summary for a person, a report for programs (INTERFACE.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ooc/run/compute_result.h"

namespace reeb::tools {

struct RunFacts {
  std::string path, format;
  std::uint64_t input_bytes = 0;
  std::uint64_t memory_budget_bytes = 0;  // 0: none was given
  unsigned threads = 1;
};

void print_summary(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results);

// The JSON text of schema reeb.report.v1: an object, or with several functions an array.
std::string report_json(const RunFacts& facts, const std::vector<ooc::ComputeResult>& results);

}  // namespace reeb::tools
