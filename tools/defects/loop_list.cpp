#include "tools/defects/loop_list.h"

#include <algorithm>
#include <limits>

#include "libreeb/base/error.h"
#include "libreeb/containers/union_find.h"
#include "libreeb/hierarchy/pairing.h"
#include "ooc/reeb_file/reeb_file.h"

namespace reeb::tools {
namespace {

constexpr std::uint32_t kNoLoops = std::numeric_limits<std::uint32_t>::max();

// Of reading the loops of a graph: the graph, its pairs, and four numbers a node.
std::uint64_t graph_memory(const FileHeader& header) {
  constexpr std::uint64_t kNodeBytes = 20 + 16, kArcBytes = 4, kPairBytes = 36;  // see persistence_pairs()
  const std::uint64_t pairs = header.nodes / 2 + header.components + header.loops;
  const std::uint64_t graph =
      header.levels.empty() ? level_memory(header.nodes, header.arcs, 0) : header.levels.back().memory_bytes;
  return graph + header.nodes * kNodeBytes + header.arcs * kArcBytes + pairs * kPairBytes;
}

}  // namespace

LoopName name_of(const LoopList& list, const Loop& loop) {
  return {loop.lo.key.vertex.value(), loop.hi.key.vertex.value(), list.functions[loop.function].name};
}

LoopList read_loops(std::span<const std::string> files, MemoryBudget& budget) {
  LoopList list;
  list.memory = budget.reserve("loops", 0);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  list.box = {Point{kFar, kFar, kFar}, Point{-kFar, -kFar, -kFar}};
  for (const std::string& path : files) {
    const ooc::ReebFile file(path);
    const FileHeader& header = file.header();
    LoopFunction function{path,
                          header.function,
                          {header.function_min, header.function_max},
                          {header.mesh_vertices, header.mesh_triangles},
                          header.components,
                          header.arcs,
                          {}};
    if (!list.functions.empty() && list.functions[0].mesh != function.mesh)
      throw Error(ErrorKind::kBadInput, "it is of another mesh than " + files[0], "name files of the same mesh")
          .at(path);
    if (!header.flags.has_positions && header.nodes != 0)
      throw Error(ErrorKind::kBadInput, "its nodes have no positions", "compute it again").at(path);
    const Reservation memory = budget.reserve("graph of the loops", graph_memory(header));
    const ReebGraph graph = file.load(0).graph;
    UnionFind component(static_cast<std::uint32_t>(graph.node_count()));
    std::vector<std::uint32_t> up(graph.node_count(), 0), down(graph.node_count(), 0);
    for (std::size_t i = 0; i < graph.arc_count(); ++i) {
      component.unite(graph.lo[i].value(), graph.hi[i].value());
      ++up[graph.lo[i].value()];
      ++down[graph.hi[i].value()];
    }
    const auto node = [&](NodeId id) { return SettledNode{graph.nodes[id.value()], graph.positions[id.value()]}; };
    const std::vector<PersistencePair> pairs = persistence_pairs(graph);
    std::size_t loops = 0, components = 0;
    std::vector<std::uint32_t> number(graph.node_count(), kNoLoops);  // of the component, at its root
    for (const PersistencePair& pair : pairs) {
      if (pair.type != PairType::kExt1) continue;
      ++loops;
      std::uint32_t& root = number[component.find(pair.lo.value())];
      if (root == kNoLoops) ++components;
      root = 0;
    }
    list.memory.resize(list.memory.bytes() + loops * sizeof(Loop) + components * sizeof(SettledNode));
    list.loops.reserve(list.loops.size() + loops);
    function.tops.reserve(components);
    for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
      const std::uint32_t root = component.find(i);
      if (number[root] != kNoLoops) {
        if (root == i) {
          number[i] = static_cast<std::uint32_t>(function.tops.size());
          function.tops.emplace_back();
        }
        function.tops[number[root]] = node(NodeId(i));  // nodes ascend
      }
      for (std::size_t k = 0; k < 3; ++k) {
        list.box[0][k] = std::min(list.box[0][k], graph.positions[i][k]);
        list.box[1][k] = std::max(list.box[1][k], graph.positions[i][k]);
      }
    }
    for (const PersistencePair& pair : pairs)
      if (pair.type == PairType::kExt1)
        list.loops.push_back({list.functions.size(), node(pair.lo), node(pair.hi),
                              number[component.find(pair.lo.value())], up[pair.lo.value()] == 2,
                              down[pair.hi.value()] == 2});
    list.functions.push_back(std::move(function));
  }
  return list;
}

}  // namespace reeb::tools
