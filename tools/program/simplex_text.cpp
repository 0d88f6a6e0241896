#include "tools/program/simplex_text.h"

#include <algorithm>
#include <array>

#include "libreeb/base/count_text.h"

namespace reeb::tools {
namespace {

constexpr std::array kOne = {"point", "edge", "triangle", "tetrahedron"};
constexpr std::array kMany = {"points", "edges", "triangles", "tetrahedra"};

}  // namespace

std::string simplices_of_dimension(std::size_t k) {
  return k < kMany.size() ? kMany[k] : std::to_string(k) + "-simplices";
}

std::string count_simplices(const SimplexCounts& counts) {
  std::string text;
  for (std::size_t k = counts.size(); k-- > 0;) {
    if (counts[k] == 0) continue;
    const std::string one = k < kOne.size() ? kOne[k] : std::to_string(k) + "-simplex";
    text +=
        (text.empty() ? "" : ", ") + with_commas(counts[k]) + " " + (counts[k] == 1 ? one : simplices_of_dimension(k));
  }
  return text.empty() ? "0 triangles" : text;
}

std::string text_if_apart(std::uint64_t triangles, std::uint64_t components, std::uint64_t arcs) {
  constexpr std::uint64_t kFew = 100;
  if (triangles < kFew || 2 * std::min(components, arcs) <= triangles) return {};
  return "most triangles share no vertex with others: vertices in the same place are not joined (except in STL); if "
         "they should be, join them with another program first";
}

}  // namespace reeb::tools
