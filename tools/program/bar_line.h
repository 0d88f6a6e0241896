// The text of a progress bar.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace reeb::tools {

struct BarState {
  std::string title;        // "2/4 sorting on disk"
  double share = -1;        // done, 0 to 1; negative: unknown
  double seconds = 0;       // in this pass so far
  double millions = 0;      // triangles per second, in millions; 0: unknown
  std::uint64_t bytes = 0;  // of memory
};

// One line of at most `columns` columns: title, bar, share, rate, time left and memory. What does not fit is left out,
// the bar first: it shrinks, then memory goes, then the rate, then the bar.
std::string bar_line(const BarState& state, std::size_t columns);

}  // namespace reeb::tools
