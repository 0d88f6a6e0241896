// One page about a `.reeb` file: what `reeb report` writes.
#pragma once

#include <cstddef>
#include <functional>
#include <ostream>
#include <string>

#include "tools/defects/find_defects.h"

namespace reeb::tools {

struct ReportOptions {
  std::string file;
  FindDefectsOptions defects;  // its mesh has no path: without a mesh
  std::size_t nodes = 2000;    // at most, of the finest level in the skeleton
  std::function<void()> counting{};
};

// THROWS: Error{kResource} in a program that was built without pages; else nothing.
void require_pages();

// MEMORY: 8 bytes per node and loop of the file, and the level that is shown; with a mesh, that of find_defects() and
//         of a census.
// THROWS: as ReebFile, find_defects() and ooc::take_census().
std::string make_report(const ReportOptions& options);

}  // namespace reeb::tools
