// Graphs as arrays of numpy.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <span>

#include "libreeb/graph/reeb_graph.h"

namespace reeb::python {

struct NodeRow {
  std::int64_t vertex;
  double value, x, y, z;
  std::int32_t down, up;
};

// {"nodes": NodeRow, "arcs": (m, 2) int64}. Without positions, x, y and z are NaN.
pybind11::dict graph_arrays(const ReebGraph& graph);

template <class T>
pybind11::array_t<T> to_array(std::span<const T> values) {
  return pybind11::array_t<T>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

}  // namespace reeb::python
