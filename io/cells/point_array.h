// Values at vertices, one or several per vertex, by the names that a user gives them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace reeb::io {

struct PointArray {
  std::string name;
  std::uint64_t components = 1;
};

// "NAME" for one component, else "NAME:0", "NAME:1", ... Of many components, as none that a user wants has, the first.
std::vector<std::string> property_names(std::span<const PointArray> arrays);

// One component of an array.
struct PointColumn {
  std::size_t array = 0;
  std::uint64_t component = 0;
};

// The array of this name if it has one component, else that of "NAME:COMPONENT". Of equal names the first counts.
// THROWS: Error{kBadInput} if there is none.
PointColumn find_point_column(std::span<const PointArray> arrays, const std::string& property, const std::string& file);

}  // namespace reeb::io
