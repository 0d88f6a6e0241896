#include "io/vtk/vtk_reader.h"

#include <algorithm>
#include <utility>

#include "io/cells/cell_reader.h"
#include "io/vtk/grid_input.h"
#include "io/vtk/legacy_header.h"
#include "io/vtk/xml_header.h"

namespace reeb::io {
namespace {

// How many arrays are read; types of cells are read twice.
std::uint64_t arrays_read(const GridFile& file, const ReadOptions& options) {
  std::uint64_t arrays = 0;
  for (const GridPiece& piece : file.pieces) {
    if (piece.points != 0) arrays += 1 + options.properties.size();
    for (const PlacedPointArray& array : piece.arrays)
      if (options.all_properties) arrays += std::min(array.components, kMostNamedComponents);
    for (const CellList& list : piece.cells)
      if (list.count != 0) arrays += 1u + (list.layout == CellLayout::kCounted ? 0u : 1u) + (list.has_types ? 2u : 0u);
  }
  return arrays;
}

std::unique_ptr<MeshReader> open_grid_file(std::shared_ptr<const ContentSource> content, GridFile file,
                                           const ReadOptions& options) {
  // For each array, a packed file is unpacked from its beginning: a few times cost less than a copy.
  constexpr std::uint64_t kMostUnpacked = 32;
  if (!content->can_seek() && arrays_read(file, options) > kMostUnpacked) {
    file.packed_bytes = content->file_bytes();
    content = copy_content(*content->reopen(), options.temp_folder);
  }
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
