// Properties of vertices, as they are passed from a reader to a writer.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace reeb::io {

// Erases the columns of a batch whose property has this name, so that another one can take its place. `names` are those
// of the reader.
inline void erase_property(std::vector<std::vector<double>>& columns, const std::vector<std::string>& names,
                           const std::string& name) {
  for (std::size_t k = names.size(); k-- > 0;)
    if (names[k] == name) columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(k));
}

}  // namespace reeb::io
