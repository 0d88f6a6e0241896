// One page about a `.reeb` file: what `reeb report` writes.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "tools/defects/find_defects.h"

namespace reeb::tools {

struct ReportOptions {
  std::string file;
  FindDefectsOptions defects;  // its mesh has no path: without a mesh
  // At most, of the finest level in the skeleton. Nothing: 2000, and more if the coarsest level has some more.
  std::optional<std::size_t> nodes;
  std::function<void()> counting{};
  std::function<void(const std::string&)> note{};  // what the page lacks
};
inline constexpr std::size_t kMostReportNodes = 100'000;

// THROWS: Error{kResource} in a program that was built without pages; else nothing.
void require_pages();

// MEMORY: 8 bytes per node and loop of the file, and the level that is shown; with a mesh, that of find_defects() and
//         of a census.
// THROWS: as ReebFile, find_defects() and ooc::take_census().
std::string make_report(const ReportOptions& options);

}  // namespace reeb::tools
