#include "ooc/distributed/part_union.h"

#include <algorithm>

#include "libreeb/base/error.h"

namespace reeb::ooc {
namespace {

std::string name_of(const PartSpan& run) {
  const std::string first = std::to_string(run.first + 1);
  return run.first == run.last ? first : first + "-" + std::to_string(run.last + 1);
}

}  // namespace

std::string part_names(const std::vector<PartSpan>& runs) {
  const bool is_one = runs.size() == 1 && runs[0].first == runs[0].last;
  std::string text = is_one ? "part " : "parts ";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i != 0) text += i + 1 == runs.size() ? " and " : ", ";
    text += name_of(runs[i]);
  }
  return text;
}

PartInfo united_info(const std::vector<NamedPart>& parts) {
  PartInfo united = parts[0].info;
  united.range = {};
  united.degenerate_triangles = united.unused_vertices = united.removed_pairs = 0;
  united.settled_nodes = united.settled_arcs = 0;
  PartSet have(united.mesh.shares.parts);
  for (const auto& [path, info] : parts) {
    if (const std::string why = difference(info, parts[0].info); !why.empty())
      throw Error(ErrorKind::kBadInput, "this fragment " + why,
                  "glue fragments that were made with the same mesh, function and options as " + parts[0].path)
          .at(path);
    for (const PartSpan& run : info.runs)
      for (std::uint32_t part = run.first; part <= run.last; ++part)
        if (have.contains(part))
          throw Error(ErrorKind::kBadInput,
                      "part " + std::to_string(part + 1) + " of " + std::to_string(united.mesh.shares.parts) +
                          " is here a second time",
                      "name each part once")
              .at(path);
    for (const PartSpan& run : info.runs) have.add(run);
    if (info.range.min <= info.range.max) {
      united.range.add(info.range.min);
      united.range.add(info.range.max);
    }
    united.degenerate_triangles += info.degenerate_triangles;
    united.unused_vertices += info.unused_vertices;
    united.removed_pairs += info.removed_pairs;
    united.settled_nodes += info.settled_nodes;
    united.settled_arcs += info.settled_arcs;
    united.live.vertices = std::max(united.live.vertices, info.live.vertices);
    united.live.edges = std::max(united.live.edges, info.live.edges);
    united.live.arcs = std::max(united.live.arcs, info.live.arcs);
  }
  united.runs = have.runs();
  return united;
}

void require_all_parts(const std::vector<NamedPart>& parts, const PartInfo& united) {
  const std::uint32_t all = united.mesh.shares.parts;
  if (united.runs.size() == 1 && united.runs[0] == PartSpan{0, all - 1}) return;
  PartSet have(all);
  for (const PartSpan& run : united.runs) have.add(run);
  const std::string part = std::to_string(have.first_missing() + 1) + " of " + std::to_string(all);
  throw Error(ErrorKind::kBadInput, "part " + part + " is missing",
              "name the fragments of all parts, or write a fragment with -o NAME.fragment")
      .at(parts[0].path);
}

}  // namespace reeb::ooc
