// Fragments of one function put together: which shares are in, and what they are of.
#pragma once

#include <string>
#include <vector>

#include "libreeb/parts/part_set.h"
#include "ooc/distributed/part_info.h"

namespace reeb::ooc {

struct NamedPart {
  std::string path;
  PartInfo info;
};

// What all of them together are: of the same mesh, function and options. The counts of settled nodes and arcs are
// those of all.
// THROWS: Error{kBadInput} that names the file: it does not belong to the first one, or has a part a second time.
// REQUIRES: there is at least one.
PartInfo united_info(const std::vector<NamedPart>& parts);

// THROWS: Error{kBadInput} that names the first file, if a part is missing.
void require_all_parts(const std::vector<NamedPart>& parts, const PartInfo& united);

// "part 2", "parts 1-3 and 5", as users count them.
std::string part_names(const std::vector<PartSpan>& runs);

}  // namespace reeb::ooc
