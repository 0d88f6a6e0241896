// The pairs of largest persistence of a `.reeb` file of any size, and how large all loops are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ooc/reeb_file/reeb_file.h"

namespace reeb::ooc {

struct LargestPairs {
  std::vector<PairRow> rows;              // in the order of `reeb pairs`: by persistence, descending
  std::vector<double> loops;              // persistences of all loops (Ext1), descending
  std::array<std::uint64_t, 4> counts{};  // of all pairs, by type
};

// At most `most` rows; where persistences are equal, the earlier ones in the file.
// TIME:   reads the whole file, and its first frames again: those with the nodes of these pairs.
// MEMORY: 8 bytes per node and per loop of the file, and the rows.
// THROWS: as ReebFile; for a file without a hierarchy.
LargestPairs read_largest_pairs(const std::string& path, std::size_t most);

}  // namespace reeb::ooc
