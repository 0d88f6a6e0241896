// Values at vertices, one or several per vertex, by the names that a user gives them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/text/entry_limit.h"

namespace reeb::io {

struct PointArray {
  std::string name;
  std::uint64_t components = 1;
};

inline constexpr std::uint64_t kMostNamedComponents = 64;

// "NAME" for one component, else "NAME:0", "NAME:1", ... At most the first kMostNamedComponents are named.
std::vector<std::string> property_names(std::span<const PointArray> arrays);

// Counts the properties that have names. THROWS: as EntryLimit::add().
template <class Place>
void count_properties(const PointArray& array, EntryLimit& limit, const Place& place) {
  limit.add(std::min(array.components, kMostNamedComponents), array.name.size(), place);
}

// One component of an array.
struct PointColumn {
  std::size_t array = 0;
  std::uint64_t component = 0;
};

// The array of this name if it has one component, else that of "NAME:COMPONENT". Of equal names the first counts.
// THROWS: Error{kBadInput} if there is none.
PointColumn find_point_column(std::span<const PointArray> arrays, const std::string& property, const std::string& file);

}  // namespace reeb::io
