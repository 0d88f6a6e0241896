// One volume, as an image and as the tetrahedra of its division, in every format: one and the same graph.
#include <array>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/io/vtk/vtk_files.h"
#include "tests/support/inputs/grid_complex.h"
#include "tests/support/random.h"
#include "tests/tools/program.h"

namespace reeb::test {
namespace {

using io::testing::LegacyStyle;
using io::testing::scalar_bytes;
using io::testing::VtkGrid;
using io::testing::XmlStyle;

constexpr GridShape kShape = {7, 6, 5};

// Values with ties, which are the same as float and double and in six digits.
std::vector<double> values() {
  Random random(11);
  std::vector<double> result;
  for (std::uint64_t i = 0; i < vertices_of(kShape); ++i) result.push_back(static_cast<double>(random.below(97)) / 4);
  return result;
}

VtkGrid grid() {
  VtkGrid grid;
  for (std::uint64_t k = 0; k < kShape[2]; ++k)
    for (std::uint64_t j = 0; j < kShape[1]; ++j)
      for (std::uint64_t i = 0; i < kShape[0]; ++i)
        grid.points.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
  for (const auto& simplex : simplices_of_grid(kShape, std::vector<bool>(vertices_of(kShape), true)))
    grid.cells.push_back({10, {simplex.begin(), simplex.end()}});
  return grid;
}

// A line for each vertex or cell: `before` the number, then its coordinates or its corners from `first_corner`.
std::string vertex_lines(const VtkGrid& grid, const std::string& after = {}) {
  std::ostringstream out;
  for (const auto& [x, y, z] : grid.points) out << x << ' ' << y << ' ' << z << after << '\n';
  return out.str();
}
std::string cell_lines(const VtkGrid& grid, const std::string& before, std::int64_t first, const std::string& after) {
  std::ostringstream out;
  for (const auto& cell : grid.cells) {
    out << before;
    for (const std::int64_t node : cell.nodes) out << node + first << ' ';
    out << after << '\n';
  }
  return out.str();
}
std::string numbered(const std::string& lines, std::uint64_t first, const std::string& before = {}) {
  std::istringstream in(lines);
  std::string text;
  for (std::string line; std::getline(in, line);) text += before + std::to_string(first++) + " " + line + "\n";
  return text;
}

std::string cx(const VtkGrid& grid) {
  std::ostringstream out;
  for (const auto& [x, y, z] : grid.points) out << "v " << x << ' ' << y << ' ' << z << '\n';
  return out.str() + cell_lines(grid, "s ", 0, "");
}

std::string medit(const VtkGrid& grid) {
  return "MeshVersionFormatted 2\nDimension 3\nVertices\n" + std::to_string(grid.points.size()) + "\n" +
         vertex_lines(grid, " 0") + "Tetrahedra\n" + std::to_string(grid.cells.size()) + "\n" +
         cell_lines(grid, "", 1, "0") + "End\n";
}

std::string msh2(const VtkGrid& grid) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(grid.points.size()) + "\n" +
         numbered(vertex_lines(grid), 1) + "$EndNodes\n$Elements\n" + std::to_string(grid.cells.size()) + "\n" +
         numbered(cell_lines(grid, "4 2 0 1 ", 1, ""), 1) + "$EndElements\n";
}

std::string msh2_binary(const VtkGrid& grid) {
  std::string out = "$MeshFormat\n2.2 1 8\n" + scalar_bytes(std::int32_t{1}, false) + "\n$EndMeshFormat\n$Nodes\n" +
                    std::to_string(grid.points.size()) + "\n";
  std::int32_t tag = 1;
  for (const auto& point : grid.points) {
    out += scalar_bytes(tag++, false);
    for (const double x : point) out += scalar_bytes(x, false);
  }
  out += "\n$EndNodes\n$Elements\n" + std::to_string(grid.cells.size()) + "\n";
  for (const std::int32_t number : {4, static_cast<std::int32_t>(grid.cells.size()), 2})
    out += scalar_bytes(number, false);
  tag = 1;
  for (const auto& cell : grid.cells) {
    for (const std::int32_t number : {tag++, 0, 1}) out += scalar_bytes(number, false);
    for (const std::int64_t node : cell.nodes) out += scalar_bytes(static_cast<std::int32_t>(node + 1), false);
  }
  return out + "\n$EndElements\n";
}

std::string msh4(const VtkGrid& grid) {
  const std::string points = std::to_string(grid.points.size()), cells = std::to_string(grid.cells.size());
  std::string tags;
  for (std::size_t i = 1; i <= grid.points.size(); ++i) tags += std::to_string(i) + "\n";
  return "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 " + points + " 1 " + points + "\n3 1 0 " + points + "\n" +
         tags + vertex_lines(grid) + "$EndNodes\n$Elements\n1 " + cells + " 1 " + cells + "\n3 1 4 " + cells + "\n" +
         numbered(cell_lines(grid, "", 1, ""), 1) + "$EndElements\n";
}

std::string msh4_binary(const VtkGrid& grid) {
  const auto size = [](std::size_t value) { return scalar_bytes(std::uint64_t{value}, false); };
  const auto integers = [](int a, int b, int c) {
    return scalar_bytes(std::int32_t{a}, false) + scalar_bytes(std::int32_t{b}, false) +
           scalar_bytes(std::int32_t{c}, false);
  };
  const std::size_t points = grid.points.size(), cells = grid.cells.size();
  std::string out = "$MeshFormat\n4.1 1 8\n" + scalar_bytes(std::int32_t{1}, false) + "\n$EndMeshFormat\n$Nodes\n";
  out += size(1) + size(points) + size(1) + size(points) + integers(3, 1, 0) + size(points);
  for (std::size_t i = 1; i <= points; ++i) out += size(i);
  for (const auto& point : grid.points)
    for (const double x : point) out += scalar_bytes(x, false);
  out += "\n$EndNodes\n$Elements\n" + size(1) + size(cells) + size(1) + size(cells) + integers(3, 1, 4) + size(cells);
  std::size_t tag = 1;
  for (const auto& cell : grid.cells) {
    out += size(tag++);
    for (const std::int64_t node : cell.nodes) out += size(static_cast<std::size_t>(node + 1));
  }
  return out + "\n$EndElements\n";
}

std::string doubles(const std::vector<double>& numbers) {
  std::string bytes;
  for (const double number : numbers) bytes += scalar_bytes(number, false);
  return bytes;
}

class SameCells : public ProgramTest {
 protected:
  // The graph as text, without the line that names the mesh.
  std::string graph(const std::string& mesh, const std::string& function,
                    const std::vector<std::string>& options = {}) {
    SCOPED_TRACE(mesh);
    std::vector<std::string> words{"compute", mesh, "-f", function, "-o", "g.reeb", "--quiet", "--force"};
    words.insert(words.end(), options.begin(), options.end());
    expect_success(reeb(words));
    const Outcome text = reeb({"extract", "g.reeb"});
    expect_success(text);
    std::istringstream lines(text.output);
    std::string graph;
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#')) graph += line + "\n";
    return graph;
  }
};

TEST_F(SameCells, OneGraphFromEveryFormat) {
  const VtkGrid mesh = grid();
  const std::vector<double> of_vertices = values();
  write("v.f64", doubles(of_vertices));
  write("m.cx", cx(mesh));
  const std::vector<std::string> functions = {"file:v.f64", "x", "z", "random:1"};
  std::vector<std::string> expected;
  for (const std::string& function : functions) expected.push_back(graph("m.cx", function));
  EXPECT_GT(expected[0].size(), 1000u);

  std::vector<std::pair<std::string, std::string>> files = {{"m.mesh", medit(mesh)},
                                                            {"m2.msh", msh2(mesh)},
                                                            {"m2b.msh", msh2_binary(mesh)},
                                                            {"m4.msh", msh4(mesh)},
                                                            {"m4b.msh", msh4_binary(mesh)}};
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true})
      files.emplace_back(std::string("l") + (binary ? "b" : "") + (offsets ? "o" : "") + ".vtk",
                         legacy_file(mesh, {.binary = binary, .offsets = offsets}));
  for (const auto& [name, style] : {std::pair{"text.vtu", XmlStyle{}},
                                    {"inline.vtu", XmlStyle{XmlStyle::Coding::kInline, "ZLib", false, false}},
                                    {"raw.vtu", XmlStyle{XmlStyle::Coding::kAppendedRaw, "", true, true}},
                                    {"base64.vtu", XmlStyle{XmlStyle::Coding::kAppendedBase64, "LZ4", false, true}}})
    files.emplace_back(name, xml_file(mesh, style));
  for (const auto& [name, bytes] : files) write(name, bytes);
  const std::string points = std::to_string(mesh.points.size()), cells = std::to_string(mesh.cells.size());
  write("t.node", points + " 3 0 0\n" + numbered(vertex_lines(mesh), 0));
  write("t.ele", cells + " 4 0\n" + numbered(cell_lines(mesh, "", 0, ""), 0));
  files.emplace_back("t.ele", "");
  for (const char* stream : {"m.sva", "m.svb"}) {
    expect_success(reeb({"convert", "m.cx", stream, "--quiet"}));
    files.emplace_back(stream, "");
  }
  for (const auto& [name, bytes] : files)
    for (std::size_t f = 0; f < functions.size(); ++f)
      EXPECT_EQ(graph(name, functions[f]), expected[f]) << name << " " << functions[f];
}

TEST_F(SameCells, AnImageHasTheGraphOfItsTetrahedra) {
  const std::vector<double> of_vertices = values();
  write("v.f64", doubles(of_vertices));
  write("m.cx", cx(grid()));
  const std::string expected = graph("m.cx", "file:v.f64");
  write("v.nrrd",
        "NRRD0004\ntype: double\ndimension: 3\nsizes: 7 6 5\nendian: little\nencoding: raw\n\n" + doubles(of_vertices));
  EXPECT_EQ(graph("v.nrrd", "value"), expected);
  EXPECT_EQ(graph("v.f64", "value", {"--grid", "7x6x5", "--type", "f64le"}), expected);
  write("v.mha",
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 7 6 5\n"
        "ElementType = MET_DOUBLE\nElementDataFile = LOCAL\n" +
            doubles(of_vertices));
  EXPECT_EQ(graph("v.mha", "value"), expected);
  std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (7, 6, 5), }";
  header.resize(117, ' ');
  write("v.npy", std::string("\x93NUMPY\x01\x00", 8) + scalar_bytes(std::uint16_t{118}, false) + header + "\n" +
                     doubles(of_vertices));
  EXPECT_EQ(graph("v.npy", "value"), expected);
  io::testing::XmlWriter writer({XmlStyle::Coding::kAppendedRaw, "ZLib", false, false});
  const std::string array = writer.array("Float64", "a", of_vertices);
  std::string vti =
      writer.file("ImageData", "<Piece Extent=\"0 6 0 5 0 4\"><PointData>" + array + "</PointData></Piece>");
  const std::string open = "<ImageData>";
  vti.replace(vti.find(open), open.size(),
              "<ImageData WholeExtent=\"0 6 0 5 0 4\" Origin=\"0 0 0\" Spacing=\"1 1 1\">");
  write("v.vti", vti);
  EXPECT_EQ(graph("v.vti", "value"), expected);
  std::string nifti(352, '\0');
  const auto put = [&](std::size_t at, const std::string& bytes) { nifti.replace(at, bytes.size(), bytes); };
  const auto short_at = [&](std::size_t at, int value) {
    put(at, scalar_bytes(static_cast<std::int16_t>(value), false));
  };
  put(0, scalar_bytes(std::int32_t{348}, false));
  for (const auto& [at, value] :
       {std::pair{40, 3}, {42, 7}, {44, 6}, {46, 5}, {48, 1}, {50, 1}, {52, 1}, {54, 1}, {70, 64}, {72, 64}})
    short_at(static_cast<std::size_t>(at), value);
  for (std::size_t k = 0; k < 4; ++k) put(76 + 4 * k, scalar_bytes(1.0F, false));
  put(108, scalar_bytes(352.0F, false));
  put(344, std::string("n+1\0", 4));
  write("v.nii", nifti + doubles(of_vertices));
  EXPECT_EQ(graph("v.nii", "value"), expected);
}

}  // namespace
}  // namespace reeb::test
