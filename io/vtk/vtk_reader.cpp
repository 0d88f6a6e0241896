#include "io/vtk/vtk_reader.h"

#include <utility>

#include "io/cells/cell_reader.h"
#include "io/vtk/grid_input.h"
#include "io/vtk/legacy_header.h"
#include "io/vtk/xml_header.h"

namespace reeb::io {
namespace {

std::unique_ptr<MeshReader> open_grid_file(const std::shared_ptr<const ContentSource>& content, GridFile file,
                                           const ReadOptions& options) {
  file.has_inner_nodes = has_higher_order_cells(*content, file);
  auto shared = std::make_shared<const GridFile>(std::move(file));
  return read_cells(
      [content, shared](const ReadOptions& of_vertices) { return open_grid_input(content, shared, of_vertices); },
      options);
}

}  // namespace

std::unique_ptr<MeshReader> open_vtk_legacy(std::unique_ptr<ContentSource> content, const ReadOptions& options) {
  GridFile file = read_legacy_header(*content);
  return open_grid_file(std::move(content), std::move(file), options);
}

std::unique_ptr<MeshReader> open_vtk_xml(std::unique_ptr<ContentSource> content, const ReadOptions& options) {
  GridFile file = read_xml_header(*content);
  return open_grid_file(std::move(content), std::move(file), options);
}

}  // namespace reeb::io
