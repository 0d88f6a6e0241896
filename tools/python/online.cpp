// The on-line graph, in batches.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/engine/online_reeb.h"
#include "tools/python/graph_arrays.h"
#include "tools/python/module.h"
#include "tools/python/strided_array.h"

namespace reeb::python {

namespace py = pybind11;

namespace {

using Numbers = py::array_t<double, py::array::c_style>;
using Ids = py::array_t<std::int64_t, py::array::c_style>;

// The place of an item is said; those before it were added.
template <class Work>
void at_item(const char* array, std::size_t item, const Work& work) {
  try {
    work();
  } catch (Error& error) {
    error.at(kNoFile, place_in(array, std::to_string(item)));
    throw;
  }
}

// Indices of unsigned types beyond those of std::int64_t are negative here.
VertexId vertex_of(std::int64_t id, bool is_unsigned) {
  if (id < 0 && !is_unsigned)
    throw Error(ErrorKind::kBadInput, "names vertex " + std::to_string(id), "vertices are numbered from 0");
  return VertexId(static_cast<std::uint64_t>(id));
}

// Returns the index of the first; 0 if there is none.
std::uint64_t add_vertices(OnlineReeb& graph, const Numbers& values, const Numbers& positions) {
  const auto count = static_cast<std::size_t>(values.size());
  const double* const value = values.data();
  const double* const position = positions.size() == 0 ? nullptr : positions.data();
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Point place{};
    if (position != nullptr) std::copy_n(position + 3 * i, 3, place.begin());
    at_item(std::isfinite(value[i]) ? "positions" : "values", i, [&] {
      const VertexId added = graph.add_vertex(value[i], place);
      if (i == 0) first = added.value();
    });
  }
  return first;
}

void add_simplices(OnlineReeb& graph, const Ids& simplices, bool is_unsigned) {
  const auto rows = static_cast<std::size_t>(simplices.shape(0)), width = static_cast<std::size_t>(simplices.shape(1));
  const std::int64_t* corner = simplices.data();
  std::vector<VertexId> corners(width);
  for (std::size_t i = 0; i < rows; ++i) {
    at_item("simplices", i, [&] {
      for (VertexId& id : corners) id = vertex_of(*corner++, is_unsigned);
      graph.add_simplex(corners);
    });
  }
}

void finalize(OnlineReeb& graph, const Ids& ids, bool is_unsigned) {
  const std::int64_t* const id = ids.data();
  for (std::size_t i = 0; i < static_cast<std::size_t>(ids.size()); ++i)
    at_item("ids", i, [&] { graph.finalize(vertex_of(id[i], is_unsigned)); });
}

}  // namespace

void add_online(py::module_& module) {
  py::class_<OnlineReeb>(module, "Online")
      .def(py::init<>())
      .def("add_vertices", &add_vertices)
      .def("add_simplices", &add_simplices)
      .def("finalize", &finalize)
      // The GIL is held: another thread of Python may add to the same graph.
      .def("snapshot", [](OnlineReeb& graph) { return graph_arrays(graph.snapshot()); })
      .def("memory_bytes", &OnlineReeb::memory_bytes);
}

}  // namespace reeb::python
