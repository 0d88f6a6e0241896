// Pictures of graphs.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "ooc/reeb_file/reeb_file.h"
#include "tools/library/temp_folder.h"
#include "tools/plot/charts.h"
#include "tools/plot/picture_file.h"
#include "tools/plot/skeleton.h"
#include "tools/python/module.h"
#include "tools/python/without_gil.h"

namespace reeb::python {

namespace py = pybind11;

namespace {

// The level is named by the threshold that was asked for, if one was.
std::string plot(const std::shared_ptr<ooc::ReebFile>& file, std::uint32_t version, const std::string& threshold,
                 const std::string& kind, const std::string& mesh, const std::optional<std::array<double, 3>>& view) {
  const WithoutGil released;
  const TempFolder folder("");
  tools::LevelChoice level;
  level.threshold = threshold;
  if (threshold.empty()) level.version = version;
  if (kind == "graph") return tools::draw_graph(*file, level, folder.path());
  if (kind == "diagram") return tools::draw_diagram(*file, level, folder.path());
  if (kind == "loops") return tools::draw_loops(std::span(file.get(), 1), level, folder.path());
  if (kind != "skeleton")
    throw Error(ErrorKind::kUsage, "there is no picture of kind \"" + kind + '"',
                "one of: graph skeleton diagram loops");
  tools::SkeletonOptions options;
  options.level = level;
  options.mesh = mesh;
  options.view = view;
  options.temp_folder = folder.path();
  return tools::draw_skeleton(*file, options);
}

py::bytes picture(const std::string& svg, const std::string& output) {
  std::string bytes;
  {
    const WithoutGil released;
    const tools::PictureFormat format = tools::picture_format(output);
    tools::require_programs(format);
    const TempFolder folder("");
    bytes = tools::picture_bytes(svg, format, folder.path());
  }
  return bytes;
}

}  // namespace

void add_plots(py::module_& module) {
  module.def("plot", &plot);
  module.def("picture", &picture);
}

}  // namespace reeb::python
