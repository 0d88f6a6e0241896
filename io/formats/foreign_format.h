// Files of kinds that are not read, by their first bytes, so that messages can name them.
#pragma once

#include <string_view>

namespace reeb::io {

struct ForeignFormat {
  std::string_view name;      // "a COLLADA scene"; empty: the format is not known
  bool may_be_mesh = true;    // it can hold a mesh or an image, but is not read yet
  std::string_view advice{};  // what makes it readable; or empty
};

// Never names a format that is read, but for images of VTK XML files (open_grid.h).
ForeignFormat foreign_format(std::string_view head);

}  // namespace reeb::io
