#include "io/cells/point_array.h"

#include <algorithm>

#include "io/mesh/missing_property.h"
#include "io/text/words.h"

namespace reeb::io {
std::vector<std::string> property_names(std::span<const PointArray> arrays) {
  std::vector<std::string> names;
  for (const PointArray& array : arrays) {
    if (array.components == 1) names.push_back(array.name);
    for (std::uint64_t k = 0; array.components > 1 && k < std::min(array.components, kMostNamedComponents); ++k)
      names.push_back(array.name + ":" + std::to_string(k));
  }
  return names;
}

PointColumn find_point_column(std::span<const PointArray> arrays, const std::string& property,
                              const std::string& file) {
  for (std::size_t i = 0; i < arrays.size(); ++i)
    if (arrays[i].name == property && arrays[i].components == 1) return {i, 0};
  if (const std::size_t colon = property.rfind(':'); colon != std::string::npos) {
    const auto component = whole_number<std::uint64_t>(std::string_view(property).substr(colon + 1));
    for (std::size_t i = 0; component && i < arrays.size(); ++i)
      if (arrays[i].name == property.substr(0, colon) && *component < arrays[i].components) return {i, *component};
  }
  throw missing_property(property, property_names(arrays)).at(file);
}

}  // namespace reeb::io
