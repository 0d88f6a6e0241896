// The files of cells to start fuzzing from.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/fuzz/corpus.h"
#include "tests/io/cells/cell_files.h"
#include "tests/io/vtk/vtk_files.h"

namespace reeb::test {
namespace {

using namespace reeb::io::testing;

// A hexahedron, a prism, a pyramid, a quadratic triangle and simplices.
VtkGrid small_grid() {
  VtkGrid grid;
  for (int i = 0; i < 10; ++i) {
    grid.points.push_back({1.0 * (i % 2), 0.5 * (i / 2 % 2), 0.25 * i});
    grid.temperature.push_back(i * i);
    grid.velocity.push_back({1.0 * i, 2, 3});
  }
  grid.cells = {{12, {0, 1, 3, 2, 4, 5, 7, 6}},
                {13, {0, 1, 2, 3, 4, 5}},
                {14, {4, 5, 7, 6, 8}},
                {22, {0, 1, 2, 3, 9, 5}},
                {10, {0, 1, 2, 4}},
                {7, {0, 1, 3, 2, 8}},
                {1, {9}}};
  return grid;
}

}  // namespace

std::vector<std::string> vtk_files() {
  std::vector<std::string> files;
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true}) {
      const LegacyStyle style{binary, offsets};
      files.push_back(legacy_file(small_grid(), style));
      files.push_back(legacy_head("POLYDATA", style) + legacy_points(small_grid(), style, "float") +
                      legacy_cells("LINES", {{0, {0, 1, 2}}}, style) +
                      legacy_cells("POLYGONS", {{0, {3, 0, 1, 2}}, {0, {4, 5, 6}}}, style) +
                      legacy_cells("TRIANGLE_STRIPS", {{0, {0, 1, 2, 3}}}, style));
    }
  return files;
}

std::vector<std::string> vtk_xml_files() {
  std::vector<std::string> files;
  for (const XmlStyle& style : xml_styles()) files.push_back(xml_file(small_grid(), style));
  return files;
}

std::vector<std::string> msh_files() {
  return {msh4(false), msh4(true), msh4(true, true), msh2(false), msh2(true), msh2(true, true)};
}

std::vector<std::string> medit_files() {
  return {medit(), medit("1"),
          "MeshVersionFormatted 2 Dimension 2\nVertices 7\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0\n0 0 0\n0 0 0\n"
          "Quadrilaterals 1\n4 3 2 1 0\nTrianglesP2 1\n1 2 3 4 5 6 0\nEnd\n"};
}

std::vector<std::string> tetgen_files() {
  return {tetgen_cells(), "1 3 0\n0 0 1 2\n", "1 10\n0 0 1 2 3 4 0 1 2 3 4 7\n"};
}

std::string tetgen_path() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("reeb-fuzz-tetgen-" + std::to_string(::getpid()));
    Folder() {
      std::filesystem::create_directories(path);
      std::ofstream(path / "input.node") << tetgen_nodes();
    }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return (folder.path / "input.ele").string();
}

}  // namespace reeb::test
