#include "tools/program/simplex_text.h"

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

}  // namespace reeb::tools
