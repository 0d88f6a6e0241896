#include "io/mesh/missing_property.h"

#include <algorithm>
#include <cstddef>

namespace reeb::io {

Error missing_property(const std::string& name, std::span<const std::string> known) {
  constexpr std::size_t kMostNamed = 20;
  std::string hint = known.empty() ? "it has none but its coordinates" : "it has these: ";
  for (std::size_t i = 0; i < std::min(known.size(), kMostNamed); ++i) hint += (i == 0 ? "" : ", ") + known[i];
  if (known.size() > kMostNamed) hint += ", and " + std::to_string(known.size() - kMostNamed) + " more";
  return {ErrorKind::kBadInput, "the mesh has no vertex property \"" + name + "\"", hint};
}

}  // namespace reeb::io
