// Graphs in .reeb files, and in the bytes of one.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/export/graph_export.h"
#include "io/export/line_points.h"
#include "io/file/atomic_file.h"
#include "io/file/file.h"
#include "ooc/reeb_file/progressive_graph.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tools/program/input_kind.h"
#include "tools/python/graph_arrays.h"
#include "tools/python/module.h"
#include "tools/python/without_gil.h"

namespace reeb::python {

namespace py = pybind11;

namespace {

using FilePtr = std::shared_ptr<const ooc::ReebFile>;

FilePtr open_file(const std::string& path) {
  const WithoutGil released;
  if (!io::is_device(path))
    tools::require_graph_file(path, "reeb.compute(\"" + path + "\") computes its graph",
                              "reeb.compute(mesh, output=\"scan.reeb\") writes a .reeb file");
  return std::make_shared<const ooc::ReebFile>(path);
}

// A file that is in memory only, and closed with the object.
FilePtr open_bytes(const py::bytes& content) {
  const std::string_view bytes = content;
  const WithoutGil released;
  const int descriptor = ::memfd_create("reeb", MFD_CLOEXEC);
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor);
  if (descriptor < 0) io::throw_output_error(errno, path);
  const io::File file(descriptor, path, io::File::Use::kOutput);
  file.write_at(0, std::as_bytes(std::span(bytes)));
  return std::make_shared<const ooc::ReebFile>(path);
}

// An output, which appears only when it is whole.
void write_file(const std::string& path, const py::bytes& content, bool force) {
  const std::string_view bytes = content;
  const WithoutGil released;
  io::AtomicFile file(path, {.existing = force ? io::Existing::kReplace : io::Existing::kRefuse});
  file.out().append(bytes);
  file.commit();
}

py::dict header_of(const ooc::ReebFile& file) {
  const FileHeader& header = file.header();
  py::dict dict;
  dict["function"] = name_of(header.function);
  dict["min"] = header.function_min;
  dict["max"] = header.function_max;
  dict["vertices"] = header.mesh_vertices;
  dict["triangles"] = header.mesh_triangles;
  dict["nodes"] = header.nodes;
  dict["arcs"] = header.arcs;
  dict["components"] = header.components;
  dict["loops"] = header.loops;
  dict["pairs"] = header.pairs;
  dict["kept_loops"] = header.kept_loops;
  dict["denoise"] = header.denoise_threshold;
  dict["denoised_pairs"] = header.denoised_pairs;
  dict["versions"] = header.steps + 1;
  dict["graph_only"] = header.flags.graph_only;
  dict["positions"] = header.flags.has_positions;
  dict["embedding"] = header.flags.has_embedding;
  dict["damage"] = text_of(file.damage() == nullptr ? "" : file.damage()->what());
  return dict;
}

py::bytes bytes_of(const ooc::ReebFile& file) {
  const std::size_t size = static_cast<std::size_t>(file.file_bytes());
  auto bytes = py::reinterpret_steal<py::bytes>(PyBytes_FromStringAndSize(nullptr, static_cast<py::ssize_t>(size)));
  if (!bytes) throw py::error_already_set();
  const std::span<char> content(PyBytes_AS_STRING(bytes.ptr()), size);
  {
    const WithoutGil released;
    file.read_all(std::as_writable_bytes(content));
  }
  return bytes;
}

py::list levels_of(const ooc::ReebFile& file) {
  py::list levels;
  for (const LevelLine& line : file.levels())
    levels.append(py::make_tuple(line.version, line.threshold, line.nodes, line.arcs, line.memory_bytes));
  return levels;
}

// Of all points of the lines. NaN where the file knows none: it has no spreads, or no arc at a node has a bucket.
std::vector<double> radii_of(const io::GraphView& view) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (!view.has_spreads || view.buckets.empty()) return std::vector<double>(io::all_points(view), kUnknown);
  std::vector<double> radii = io::all_radii(view);
  std::vector<bool> has_bucket(view.graph.node_count());
  for (std::size_t arc = 0; arc < view.graph.arc_count(); ++arc)
    if (io::inner_points(view, arc) != 0)
      has_bucket[view.graph.lo[arc].value()] = has_bucket[view.graph.hi[arc].value()] = true;
  for (std::size_t node = 0; node < has_bucket.size(); ++node)
    if (!has_bucket[node]) radii[node] = kUnknown;
  return radii;
}

// The graph, and the line of each arc: arc i has the points offsets[i] to offsets[i + 1], one for a bucket, with the
// number of its vertices. Radii are of the nodes, then of these points.
py::dict load(const ooc::ReebFile& file, std::uint32_t version) {
  ooc::Level level;
  std::vector<std::uint64_t> offsets{0}, counts;
  std::vector<std::array<double, 3>> points, line;
  std::vector<double> radii;
  {
    const WithoutGil released;
    level = file.load(version);
    const FileHeader& header = file.header();
    const io::GraphView view{.graph = level.graph,
                             .function = header.function,
                             .buckets = level.graph.positions.empty() ? ArcBucketsView{} : level.buckets.view(),
                             .bucket_exponent = header.bucket_exponent,
                             .has_spreads = header.flags.has_spreads};
    for (std::size_t arc = 0; arc < level.graph.arc_count(); ++arc) {
      if (!view.buckets.empty()) {
        io::draw_arc(view, arc, line);
        points.insert(points.end(), line.begin(), line.end());
        io::for_each_inner_point(view, arc, [&](const Bucket& bucket) { counts.push_back(bucket.count); });
      }
      offsets.push_back(points.size());
    }
    radii = radii_of(view);
  }
  py::dict arrays = graph_arrays(level.graph);
  arrays["threshold"] = level.threshold;
  arrays["offsets"] = to_array<std::uint64_t>(offsets);
  arrays["counts"] = to_array<std::uint64_t>(counts);
  arrays["radii"] = to_array<double>(radii);
  arrays["points"] = py::array_t<double>({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}},
                                         points.empty() ? nullptr : points.front().data());
  return arrays;
}

// In the order of cancelling.
py::dict pairs_of(const ooc::ReebFile& file) {
  std::vector<ooc::PairRow> rows;
  {
    const WithoutGil released;
    rows = file.pairs();
  }
  const auto column = [&]<class T>(T zero, const auto& get) {
    py::array_t<decltype(zero)> values(static_cast<py::ssize_t>(rows.size()));
    auto* out = values.mutable_data();
    for (const ooc::PairRow& row : rows) *out++ = get(row);
    return values;
  };
  py::dict dict;
  dict["type"] = column(std::uint8_t{}, [](const auto& row) { return static_cast<std::uint8_t>(row.type); });
  dict["kept"] = column(std::uint8_t{}, [](const auto& row) { return std::uint8_t{row.kept}; });
  for (const auto& [name, end] : {std::pair{"lo", &ooc::PairRow::lo}, std::pair{"hi", &ooc::PairRow::hi}}) {
    const std::string begin = name;
    dict[name] = column(std::int64_t{}, [end = end](const auto& row) {
      return static_cast<std::int64_t>((row.*end).key.vertex.value());
    });
    dict[py::str(begin + "_value")] = column(double{}, [end = end](const auto& row) { return (row.*end).key.value; });
    for (std::size_t axis = 0; axis < 3; ++axis)
      dict[py::str(begin + "_" + "xyz"[axis])] =
          column(double{}, [end = end, axis](const auto& row) { return (row.*end).position[axis]; });
  }
  return dict;
}

// Keeps the changes, in their order, until Python takes them.
class Changes : public ooc::GraphListener {
 public:
  void node_added(std::uint32_t node, const SettledNode& place) override {
    list_.append(py::make_tuple("node_added", node, place.key.vertex.value(), place.key.value,
                                py::make_tuple(place.position[0], place.position[1], place.position[2])));
  }
  void node_removed(std::uint32_t node) override { list_.append(py::make_tuple("node_removed", node)); }
  void arc_added(std::uint64_t arc, std::uint32_t lo, std::uint32_t hi) override {
    list_.append(py::make_tuple("arc_added", arc, lo, hi));
  }
  void arc_removed(std::uint64_t arc) override { list_.append(py::make_tuple("arc_removed", arc)); }
  py::list take() { return std::exchange(list_, py::list()); }

 private:
  py::list list_;
};

class Progressive {
 public:
  explicit Progressive(FilePtr file) : file_(std::move(file)), graph_(*file_, &changes_) {}
  py::list go_to_version(std::uint32_t version) {
    graph_.go_to_version(version);
    return changes_.take();
  }

 private:
  FilePtr file_;
  Changes changes_;
  ooc::ProgressiveGraph graph_;
};

}  // namespace

void add_files(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(NodeRow, vertex, value, x, y, z, down, up);
  py::class_<ooc::ReebFile, std::shared_ptr<ooc::ReebFile>>(module, "File")
      .def(py::init([](const std::string& path) { return std::const_pointer_cast<ooc::ReebFile>(open_file(path)); }))
      .def_static("from_bytes",
                  [](const py::bytes& content) { return std::const_pointer_cast<ooc::ReebFile>(open_bytes(content)); })
      .def("header", &header_of)
      .def("bytes", &bytes_of)
      .def("levels", &levels_of)
      .def("version_at", &ooc::ReebFile::version_at)
      .def("finest_with_nodes", &ooc::ReebFile::finest_with_nodes)
      .def("finest_with_memory", &ooc::ReebFile::finest_with_memory)
      .def("load", &load)
      .def("pairs", &pairs_of);
  module.def("write_file", &write_file);
  py::class_<Progressive>(module, "Progressive")
      .def(py::init([](const std::shared_ptr<ooc::ReebFile>& file) { return new Progressive(file); }))
      .def("go_to_version", &Progressive::go_to_version);
}

}  // namespace reeb::python
