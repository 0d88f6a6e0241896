// Extended persistence by its definition: reduction of the boundary matrix of the coned graph
// (Edelsbrunner, Harer, "Computational Topology", VII.3), without any of the production code.
#pragma once

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>
#include <vector>

#include "libreeb/graph/reeb_graph.h"
#include "libreeb/hierarchy/hierarchy.h"

namespace reeb::test {

using PairKey = std::tuple<PairType, std::uint64_t, std::uint64_t>;  // type, vertices lo and hi

// The pairs by the vertices of their nodes, sorted.
inline std::vector<PairKey> keys_of(const ReebGraph& graph,
                                    const std::vector<PersistencePair>& pairs) {
  std::vector<PairKey> keys;
  for (const PersistencePair& p : pairs)
    keys.emplace_back(p.type, graph.nodes[p.lo.value()].vertex.value(),
                      graph.nodes[p.hi.value()].vertex.value());
  std::sort(keys.begin(), keys.end());
  return keys;
}

inline std::vector<PairKey> reference_pairs(const ReebGraph& graph) {
  struct Cell {
    std::uint32_t node;                 // at which the cell enters
    bool cone;                          // of the descending half
    std::vector<std::size_t> boundary;  // rows, ascending, over Z/2
  };
  const auto nodes = static_cast<std::uint32_t>(graph.node_count());
  std::vector<Cell> cells{{0, false, {}}};  // the apex, row 0
  std::vector<std::size_t> node_row(nodes), arc_row(graph.arc_count()), cone_row(nodes);
  const auto add = [&](std::uint32_t node, bool cone, std::vector<std::size_t> boundary) {
    std::sort(boundary.begin(), boundary.end());
    cells.push_back({node, cone, std::move(boundary)});
    return cells.size() - 1;
  };
  for (std::uint32_t y = 0; y < nodes; ++y) {
    node_row[y] = add(y, false, {});
    for (std::size_t a = 0; a < graph.arc_count(); ++a)
      if (graph.hi[a].value() == y)
        arc_row[a] = add(y, false, {node_row[graph.lo[a].value()], node_row[y]});
  }
  for (std::uint32_t v = nodes; v-- > 0;) {
    cone_row[v] = add(v, true, {0, node_row[v]});
    for (std::size_t a = 0; a < graph.arc_count(); ++a)
      if (graph.lo[a].value() == v)
        add(v, true, {arc_row[a], cone_row[v], cone_row[graph.hi[a].value()]});
  }

  std::vector<PersistencePair> pairs;
  std::map<std::size_t, std::size_t> column_of_low;
  for (std::size_t column = 0; column < cells.size(); ++column) {
    auto& boundary = cells[column].boundary;
    while (!boundary.empty() && column_of_low.count(boundary.back()) != 0) {
      const auto& other = cells[column_of_low[boundary.back()]].boundary;
      std::vector<std::size_t> sum;
      std::set_symmetric_difference(boundary.begin(), boundary.end(), other.begin(), other.end(),
                                    std::back_inserter(sum));
      boundary = std::move(sum);
    }
    if (boundary.empty()) continue;
    column_of_low[boundary.back()] = column;
    const Cell& birth = cells[boundary.back()];
    const Cell& death = cells[column];
    const NodeId b(birth.node), d(death.node);
    const bool creates_component =
        birth.boundary.empty() && boundary.back() == node_row[birth.node];
    if (!death.cone && b != d) pairs.push_back({b, d, PairType::kOrd0});
    if (birth.cone && b != d) pairs.push_back({d, b, PairType::kRel1});
    if (death.cone && !birth.cone && creates_component) pairs.push_back({b, d, PairType::kExt0});
    if (death.cone && !birth.cone && !creates_component) pairs.push_back({d, b, PairType::kExt1});
  }
  return keys_of(graph, pairs);
}

}  // namespace reeb::test
