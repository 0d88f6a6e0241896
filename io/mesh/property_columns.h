// Properties of vertices, as they are passed from a reader to a writer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "libreeb/base/count_text.h"

namespace reeb::io {

// Erases the columns of a batch whose property has this name, so that another one can take its place. `names` are those
// of the reader.
inline void erase_property(std::vector<std::vector<double>>& columns, const std::vector<std::string>& names,
                           const std::string& name) {
  for (std::size_t k = names.size(); k-- > 0;)
    if (names[k] == name) columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(k));
}

// The note on that many NaN and infinities, which do not matter.
inline std::string note_on_non_finite_values(std::uint64_t count) {
  return count_of(count, "value") + " of properties that are not used " + (count == 1 ? "is" : "are") + " not finite";
}

// The note on that many integers that became other numbers.
inline std::string note_on_rounded_values(std::uint64_t count) {
  return count_of(count, "value") + " beyond 2^53 " + (count == 1 ? "was" : "were") + " rounded to the nearest double";
}

}  // namespace reeb::io
