#include "tests/model/reference_pairs.h"

#include <algorithm>
#include <map>
#include <tuple>

namespace reeb::test {
namespace {

// A cell of a filtered cell complex. Boundaries name cells by their index in the list.
struct Cell {
  unsigned dimension;
  std::size_t lowest, highest;  // rank of its lowest and highest vertex
  std::vector<std::size_t> boundary;
};

// A cell of the coned complex, in the order of the filtration.
struct Step {
  std::size_t cell;
  bool coned;  // the cone from the apex over the cell
};

using Column = std::vector<std::size_t>;  // ascending rows with coefficient 1

Column sum(const Column& a, const Column& b) {
  Column result;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

// The filtration. Going up, every cell enters with its highest vertex; then, going down, the cone over it enters with
// its lowest vertex; faces first. The apex comes before everything and is not listed.
std::vector<Step> filtration(const std::vector<Cell>& cells) {
  std::vector<Step> ascending, descending;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ascending.push_back({i, false});
    descending.push_back({i, true});
  }
  std::stable_sort(ascending.begin(), ascending.end(), [&](Step a, Step b) {
    return std::tuple(cells[a.cell].highest, cells[a.cell].dimension) <
           std::tuple(cells[b.cell].highest, cells[b.cell].dimension);
  });
  std::stable_sort(descending.begin(), descending.end(), [&](Step a, Step b) {
    return std::tuple(cells[b.cell].lowest, cells[a.cell].dimension) <
           std::tuple(cells[a.cell].lowest, cells[b.cell].dimension);
  });
  ascending.insert(ascending.end(), descending.begin(), descending.end());
  return ascending;
}

// Boundary columns; row 0 is the apex, row i + 1 is step i.
std::vector<Column> boundary_matrix(const std::vector<Cell>& cells, const std::vector<Step>& steps) {
  std::vector<std::size_t> row(cells.size()), coned_row(cells.size());
  for (std::size_t i = 0; i < steps.size(); ++i) (steps[i].coned ? coned_row : row)[steps[i].cell] = i + 1;
  std::vector<Column> columns;
  for (const Step& step : steps) {
    Column column;
    const Cell& cell = cells[step.cell];
    for (const std::size_t face : cell.boundary) column.push_back(step.coned ? coned_row[face] : row[face]);
    if (step.coned) column.push_back(row[step.cell]);
    if (step.coned && cell.dimension == 0) column.push_back(0);
    std::sort(column.begin(), column.end());
    columns.push_back(std::move(column));
  }
  return columns;
}

// Indices in `steps` of the births and deaths.
std::vector<std::pair<std::size_t, std::size_t>> reduce(std::vector<Column> columns) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::map<std::size_t, std::size_t> column_of_pivot;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    Column& column = columns[i];
    while (!column.empty() && column_of_pivot.contains(column.back()))
      column = sum(column, columns[column_of_pivot[column.back()]]);
    if (column.empty()) continue;
    column_of_pivot[column.back()] = i;
    if (column.back() > 0) pairs.emplace_back(column.back() - 1, i);
  }
  return pairs;
}

struct RankPair {
  PairType type;
  std::size_t lo, hi;
};

std::vector<RankPair> extended_pairs(const std::vector<Cell>& cells) {
  const std::vector<Step> steps = filtration(cells);
  std::vector<RankPair> result;
  for (const auto& [birth, death] : reduce(boundary_matrix(cells, steps))) {
    const Step from = steps[birth], to = steps[death];
    const Cell &born = cells[from.cell], &dying = cells[to.cell];
    // The dimension of the class is that of the cell, or of the cone, that creates it.
    const unsigned dimension = born.dimension + (from.coned ? 1 : 0);
    if (!to.coned && dimension == 0 && born.highest != dying.highest)
      result.push_back({PairType::kOrd0, born.highest, dying.highest});
    if (!from.coned && to.coned && dimension == 0) result.push_back({PairType::kExt0, born.highest, dying.lowest});
    if (!from.coned && to.coned && dimension == 1 && dying.lowest < born.highest)
      result.push_back({PairType::kExt1, dying.lowest, born.highest});
    if (from.coned && dimension == 1 && born.lowest != dying.lowest)
      result.push_back({PairType::kRel1, dying.lowest, born.lowest});
  }
  return result;
}

}  // namespace

std::vector<PersistencePair> reference_pairs(const ReebGraph& graph) {
  std::vector<Cell> cells;
  for (std::size_t v = 0; v < graph.node_count(); ++v) cells.push_back({0, v, v, {}});
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    const std::size_t lo = graph.lo[i].value(), hi = graph.hi[i].value();
    cells.push_back({1, lo, hi, {lo, hi}});
  }
  std::vector<PersistencePair> pairs;
  for (const RankPair& pair : extended_pairs(cells))
    pairs.push_back(
        {NodeId(static_cast<std::uint32_t>(pair.lo)), NodeId(static_cast<std::uint32_t>(pair.hi)), pair.type, false});
  std::sort(pairs.begin(), pairs.end(), [](const PersistencePair& a, const PersistencePair& b) {
    return std::tuple(a.type, a.lo, a.hi) < std::tuple(b.type, b.lo, b.hi);
  });
  return pairs;
}

std::vector<VertexPair> vertex_pairs(const ReebGraph& graph, const std::vector<PersistencePair>& pairs) {
  std::vector<VertexPair> result;
  for (const PersistencePair& pair : pairs)
    result.push_back({pair.type, graph.nodes[pair.lo.value()].vertex, graph.nodes[pair.hi.value()].vertex});
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<VertexPair> reference_pairs(const Complex& complex) {
  const std::vector<std::uint64_t> order = sweep_order(complex);
  std::vector<std::size_t> rank(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) rank[order[r]] = r;

  const Skeleton skeleton = two_skeleton(complex);
  std::vector<Cell> cells;
  std::map<std::array<std::uint64_t, 2>, std::size_t> cell_of_edge;
  for (std::size_t v = 0; v < order.size(); ++v) cells.push_back({0, rank[v], rank[v], {}});
  for (const auto& edge : skeleton.edges) {
    const auto [a, b] = edge;
    cell_of_edge[edge] = cells.size();
    cells.push_back({1, std::min(rank[a], rank[b]), std::max(rank[a], rank[b]), {a, b}});
  }
  for (const auto& [a, b, c] : skeleton.triangles)
    cells.push_back({2,
                     std::min({rank[a], rank[b], rank[c]}),
                     std::max({rank[a], rank[b], rank[c]}),
                     {cell_of_edge[{a, b}], cell_of_edge[{a, c}], cell_of_edge[{b, c}]}});

  std::vector<VertexPair> pairs;
  for (const RankPair& pair : extended_pairs(cells))
    pairs.push_back({pair.type, VertexId(order[pair.lo]), VertexId(order[pair.hi])});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace reeb::test
