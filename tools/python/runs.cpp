// What reads a mesh: compute, segment, defects.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/cells/cell_division.h"
#include "io/grids/grid_mesh.h"
#include "libreeb/base/error.h"
#include "ooc/run/segment.h"
#include "tools/defects/defect_text.h"
#include "tools/defects/find_defects.h"
#include "tools/defects/surface_census.h"
#include "tools/library/compute.h"
#include "tools/library/run_input.h"
#include "tools/library/temp_folder.h"
#include "tools/program/quantity.h"
#include "tools/python/array_grid.h"
#include "tools/python/array_mesh.h"
#include "tools/python/graph_arrays.h"
#include "tools/python/module.h"
#include "tools/python/watched_run.h"

namespace reeb::python {

namespace py = pybind11;

namespace {

// REQUIRES: numbers in the byte order of the machine, of at most 8 bytes, no float16.
io::ScalarType type_of(const py::array& array) {
  const char kind = array.dtype().kind();
  const auto bytes = array.itemsize();
  if (kind == 'f') return bytes == 4 ? io::ScalarType::kFloat32 : io::ScalarType::kFloat64;
  const bool is_signed = kind == 'i';
  switch (bytes) {
    case 1:
      return is_signed ? io::ScalarType::kInt8 : io::ScalarType::kUint8;
    case 2:
      return is_signed ? io::ScalarType::kInt16 : io::ScalarType::kUint16;
    case 4:
      return is_signed ? io::ScalarType::kInt32 : io::ScalarType::kUint32;
    default:
      return is_signed ? io::ScalarType::kInt64 : io::ScalarType::kUint64;
  }
}

StridedArray view_of(const py::array& array) {
  StridedArray view;
  view.data = static_cast<const char*>(array.data());
  view.type = type_of(array);
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(array.ndim()); ++axis) {
    view.size[axis] = static_cast<std::uint64_t>(array.shape(static_cast<py::ssize_t>(axis)));
    view.stride[axis] = array.strides(static_cast<py::ssize_t>(axis));
  }
  return view;
}

using NamedArrays = std::vector<std::pair<std::string, py::array>>;

// A mesh in arrays or an image, which it keeps alive.
class HeldMesh {
 public:
  static HeldMesh of_arrays(const py::array& vertices, const NamedArrays& values, const NamedArrays& simplices) {
    HeldMesh held;
    const auto mesh = std::make_shared<ArrayMesh>();
    mesh->vertices = view_of(vertices);
    held.arrays_.push_back(vertices);
    for (const auto& [name, array] : values) mesh->properties.push_back({name, held.keep(array)});
    for (const auto& [name, array] : simplices) mesh->simplices.push_back({name, held.keep(array)});
    held.open = [mesh = std::shared_ptr<const ArrayMesh>(mesh)](const ReadOptions& options) {
      return read_arrays(mesh, options);
    };
    return held;
  }

  // Axis 0 of the array is that of j, or of k.
  static HeldMesh of_image(const py::array& image, const std::vector<double>& origin,
                           const std::vector<double>& spacing, bool skip_nodata, std::optional<double> nodata) {
    ArrayGrid grid;
    grid.data = static_cast<const char*>(image.data());
    grid.type = type_of(image);
    grid.info.format = "array";
    grid.info.axes = static_cast<unsigned>(image.ndim());
    grid.info.file_bytes = static_cast<std::uint64_t>(image.nbytes());
    grid.info.nodata = nodata;
    for (std::size_t axis = 0; axis < grid.info.axes; ++axis) {
      const auto of_array = static_cast<py::ssize_t>(grid.info.axes - 1 - axis);
      grid.info.size[axis] = static_cast<std::uint64_t>(image.shape(of_array));
      grid.stride[axis] = image.strides(of_array);
      grid.info.origin[axis] = origin[axis];
      grid.info.step[axis][axis] = spacing[axis];
    }
    HeldMesh held;
    held.keep(image);
    held.open = [grid, skip_nodata](const ReadOptions& options) {
      return io::make_grid_mesh(read_grid(grid), options, {.skip_nodata = skip_nodata});
    };
    return held;
  }

  MeshOpener open;

 private:
  StridedArray keep(const py::array& array) {
    arrays_.push_back(array);
    return view_of(array);
  }

  std::vector<py::array> arrays_;
};

using Mesh = std::variant<std::string, const HeldMesh*>;

template <class T>
void take(const py::dict& options, const char* name, T& value) {
  if (options.contains(name)) value = options[name].cast<T>();
}

void take_image(const py::dict& options, io::ImageOptions& image) {
  take(options, "grid", image.grid);
  take(options, "type", image.type);
  take(options, "spacing", image.spacing);
  take(options, "skip", image.skip_bytes);
  take(options, "skip_nodata", image.skip_nodata);
}

ComputeOptions compute_options(const py::dict& given, WatchedRun& run) {
  ComputeOptions options;
  take(given, "memory", options.memory_bytes);
  take(given, "threads", options.threads);
  take(given, "replace", options.replace);
  take(given, "graph_only", options.graph_only);
  take(given, "denoise", options.denoise);
  take(given, "denoise_is_share", options.denoise_is_share);
  take(given, "buckets", options.buckets);
  take(given, "format", options.format);
  take_image(given, options.image);
  take(given, "temp_dir", options.temp_dir);
  take(given, "reorder", options.may_reorder);
  take(given, "manifold", options.manifold);
  take(given, "sidecar", options.keep_sidecar);
  take(given, "chunk", options.chunk_triangles);
  take(given, "snapshot_every", options.snapshot_every);
  take(given, "resume", options.resume);
  options.interrupted = [&run] { return run.interrupted(); };
  options.progress = [&run](const ComputeProgress& progress) { run.tell(progress); };
  return options;
}

py::dict to_dict(const ComputeResult& result) {
  py::dict dict;
  dict["function"] = name_of(result.function);
  dict["min"] = result.range.min;
  dict["max"] = result.range.max;
  dict["vertices"] = result.vertices;
  dict["simplices"] = result.simplices;
  dict["triangles"] = result.triangles();
  dict["degenerate_triangles"] = result.degenerate_triangles;
  dict["unused_vertices"] = result.unused_vertices;
  dict["nodes"] = result.nodes;
  dict["arcs"] = result.arcs;
  dict["components"] = result.betti.components;
  dict["loops"] = result.betti.loops;
  dict["kept_loops"] = result.kept_loops;
  dict["denoised_pairs"] = result.denoised_pairs;
  dict["seconds"] = result.seconds.wall;
  py::list notes;
  for (const std::string& note : result.notes) notes.append(text_of(note));
  dict["notes"] = notes;
  return dict;
}

py::list compute_graphs(const Mesh& mesh, const std::vector<std::string>& functions,
                        const std::vector<std::string>& outputs, const py::dict& given, const py::object& progress) {
  WatchedRun run(progress);
  const ComputeOptions options = compute_options(given, run);
  std::vector<ComputeResult> results;
  run.run([&] {
    results = std::holds_alternative<std::string>(mesh)
                  ? compute(std::get<std::string>(mesh), functions, outputs, options)
                  : compute(std::get<const HeldMesh*>(mesh)->open, functions, outputs, options);
  });
  std::string denoise;
  take(given, "denoise_text", denoise);
  py::list dicts;
  for (ComputeResult& result : results) {
    if (const std::string note =
            denoise.empty() ? std::string() : tools::large_threshold(denoise, result.range, result.function);
        !note.empty())
      result.notes.push_back(note);
    dicts.append(to_dict(result));
  }
  return dicts;
}

// Labels and values of all vertices.
py::tuple segment(const Mesh& mesh, const std::shared_ptr<ooc::ReebFile>& file, std::uint32_t version,
                  const py::dict& given, const py::object& progress) {
  WatchedRun run(progress);
  const ComputeOptions options = compute_options(given, run);
  std::vector<ooc::ArcLabel> labels;
  std::vector<double> values;
  run.run([&] {
    const TempFolder folder(options.temp_dir);
    const InputOptions reading{.format = options.format,
                               .image = options.image,
                               .temp_dir = folder.path(),
                               .memory_bytes = options.memory_bytes};
    const std::span<const std::string> functions(&file->header().function, 1);
    std::optional<RunInput> input;
    if (std::holds_alternative<std::string>(mesh))
      input.emplace(std::get<std::string>(mesh), functions, reading);
    else
      input.emplace(std::get<const HeldMesh*>(mesh)->open, functions, reading);
    ooc::ComputeOptions follow;
    follow.memory_bytes = options.memory_bytes;
    follow.threads = options.threads;
    follow.temp_dir = folder.path();
    follow.interrupted = options.interrupted;
    follow.progress = options.progress;
    const auto& grid = input->info().grid;
    const std::uint64_t bound = std::max(file->header().mesh_vertices, grid ? grid->vertex_count() : 0);
    const auto segmentation = ooc::segment_mesh(input->take_mesh(), *input->functions().front(),
                                                {.file = *file,
                                                 .version = version,
                                                 .vertex_bound = bound,
                                                 .output = folder.path() + "/arcs",
                                                 .options = follow});
    labels.resize(static_cast<std::size_t>(segmentation->vertex_bound()));
    values.resize(labels.size());
    segmentation->read(labels, values);
  });
  return py::make_tuple(to_array<ooc::ArcLabel>(labels), to_array<double>(values));
}

// The simplices of cells of one shape, a row each, as corners of one simplex after the other.
// THROWS: Error{kBadInput}: rows that are not as long as the cells have corners.
py::array divide(const std::string& shape, const py::array_t<std::int64_t, py::array::c_style>& cells) {
  const io::CellShape chosen = shape == "quad"         ? io::CellShape::kQuadrilateral
                               : shape == "hexahedron" ? io::CellShape::kHexahedron
                               : shape == "wedge"      ? io::CellShape::kPrism
                                                       : io::CellShape::kPyramid;
  const std::size_t width = io::corner_count(chosen);
  if (cells.ndim() != 2 || cells.shape(1) != static_cast<py::ssize_t>(width))
    throw Error(ErrorKind::kBadInput, "cells of the shape " + shape + " have " + std::to_string(width) + " corners",
                "an array of shape (m, " + std::to_string(width) + ")");
  std::vector<VertexId> cell(width);
  std::vector<std::int64_t> simplices;
  const std::int64_t* corner = cells.data();
  for (py::ssize_t i = 0; i < cells.size(); i += static_cast<py::ssize_t>(width), corner += width) {
    for (std::size_t k = 0; k < width; ++k) cell[k] = VertexId(static_cast<std::uint64_t>(corner[k]));
    const io::CellDivision division = io::divide_cell(chosen, cell);
    for (std::size_t k = 0; k < division.count * (division.dimension + 1); ++k)
      simplices.push_back(corner[division.corners[k]]);
  }
  return to_array<std::int64_t>(simplices);
}

// The JSON text of the table (docs/CLI.md).
std::string defects(const std::string& mesh, const std::vector<std::string>& files, const py::dict& given,
                    const py::object& progress) {
  WatchedRun run(progress);
  const ComputeOptions options = compute_options(given, run);
  std::ostringstream text;
  std::string note;
  run.run([&] {
    const TempFolder folder(options.temp_dir);
    tools::FindDefectsOptions find;
    find.mesh.path = mesh;
    find.mesh.format = options.format;
    find.mesh.image = options.image;
    find.mesh.temp_folder = folder.path();
    find.mesh.memory_bytes = options.memory_bytes;
    find.files = files;
    find.threads = options.threads;
    find.computing = options.progress;
    find.searching = [&run](std::uint64_t done, std::uint64_t total, std::uint64_t triangles) {
      run.tell("curves", done, total, triangles);
    };
    find.mesh.interrupted = options.interrupted;
    const tools::Defects found = tools::find_defects(find);
    std::vector<tools::RankedRow> rows;
    for (std::size_t i = 0; i < found.table.rows.size(); ++i) rows.push_back({i + 1, &found.table.rows[i]});
    tools::write_defect_json(found, rows, tools::census_of(find.mesh), text);
    note = found.note;
  });
  if (!note.empty() && PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return text.str();
}

}  // namespace

void add_runs(py::module_& module) {
  py::class_<HeldMesh>(module, "HeldMesh")
      .def_static("of_arrays", &HeldMesh::of_arrays)
      .def_static("of_image", &HeldMesh::of_image);
  module.def("compute", &compute_graphs);
  module.def("segment", &segment);
  module.def("defects", &defects);
  module.def("divide", &divide);
  module.def("parse_size", [](const std::string& text) { return tools::parse_size("memory", text); });
  module.def("large_threshold",
             [](const std::string& text, double least, double greatest, const std::string& function) {
               return tools::large_threshold(text, {least, greatest}, function);
             });
  module.def("parse_threshold", [](const std::string& name, const std::string& text, double least, double greatest) {
    return tools::parse_threshold(name, text, {least, greatest});
  });
}

}  // namespace reeb::python
