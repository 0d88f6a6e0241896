#include "tools/python/graph_arrays.h"

#include <limits>

namespace reeb::python {

namespace py = pybind11;

py::dict graph_arrays(const ReebGraph& graph) {
  const Degrees degree = degrees(graph);
  py::array_t<NodeRow> nodes(static_cast<py::ssize_t>(graph.node_count()));
  NodeRow* row = nodes.mutable_data();
  for (std::size_t i = 0; i < graph.node_count(); ++i, ++row) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    const std::array<double, 3> position =
        graph.positions.empty() ? std::array{kUnknown, kUnknown, kUnknown} : graph.positions[i];
    *row = {static_cast<std::int64_t>(graph.nodes[i].vertex.value()),
            graph.nodes[i].value,
            position[0],
            position[1],
            position[2],
            static_cast<std::int32_t>(degree.down[i]),
            static_cast<std::int32_t>(degree.up[i])};
  }
  py::array_t<std::int64_t> arcs({static_cast<py::ssize_t>(graph.arc_count()), py::ssize_t{2}});
  std::int64_t* end = arcs.mutable_data();
  for (std::size_t i = 0; i < graph.arc_count(); ++i) {
    *end++ = graph.lo[i].value();
    *end++ = graph.hi[i].value();
  }
  py::dict arrays;
  arrays["nodes"] = nodes;
  arrays["arcs"] = arcs;
  return arrays;
}

}  // namespace reeb::python
