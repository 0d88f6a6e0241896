// Files of VTK in every encoding, all types of cells, and bad files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>

#include "tests/io/vtk/vtk_files.h"

namespace reeb::io::testing {
namespace {

const VtkGrid kTwoTetrahedra = {{{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, {0, 0, 1}, {0.1, 1, 1}},
                                {{10, {0, 1, 2, 3}}, {10, {1, 2, 3, 4}}, {5, {0, 1, 2}}, {3, {0, 4}}, {1, {2}}},
                                {1, 2.5, 3, 4, -5},
                                {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}}};

Mesh expected(bool properties) {
  Mesh mesh;
  for (std::size_t i = 0; i < kTwoTetrahedra.points.size(); ++i) {
    const auto& point = kTwoTetrahedra.points[i];
    auto& vertex = mesh.vertices.emplace_back(point.begin(), point.end());
    if (properties) vertex.insert(vertex.end(), {kTwoTetrahedra.velocity[i][1], kTwoTetrahedra.temperature[i]});
  }
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  mesh.triangles = {{0, 1, 2}};
  mesh.edges = {{0, 4}};
  mesh.points = {{2}};
  return mesh;
}

std::vector<std::pair<std::string, std::string>> all_encodings(const VtkGrid& grid) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const bool binary : {false, true})
    for (const bool offsets : {false, true})
      files.emplace_back(std::string("legacy") + (binary ? "_b" : "_a") + (offsets ? "5.vtk" : "3.vtk"),
                         legacy_file(grid, {binary, offsets}));
  int number = 0;
  for (const XmlStyle& style : xml_styles())
    files.emplace_back("style" + std::to_string(number++) + ".vtu", xml_file(grid, style));
  return files;
}

TEST(VtkReader, EveryEncodingGivesTheSameMesh) {
  for (const auto& [name, bytes] : all_encodings(kTwoTetrahedra)) {
    SCOPED_TRACE(name);
    const std::string path = write_file(name, bytes);
    EXPECT_EQ(read_mesh(path), expected(false));
    EXPECT_EQ(read_mesh(path, {"velocity:1", "T"}), expected(true));
    const auto reader = open_mesh(path);
    EXPECT_EQ(reader->info().vertex_count, 5u);
    EXPECT_EQ(reader->info().simplex_count, 5u);
    const std::vector<std::string> names = {"T", "velocity:0", "velocity:1", "velocity:2"};
    EXPECT_EQ(reader->info().property_names, names);
  }
}

TEST(VtkReader, PackedFilesAreTheSameMesh) {
  for (const auto& [name, bytes] : all_encodings(kTwoTetrahedra)) {
    SCOPED_TRACE(name);
    const std::string path = write_file(name, bytes);
    for (const auto& [command, ending] : {std::pair("gzip -c", ".gz"), {"zstd -qc", ".zst"}}) {
      ASSERT_EQ(std::system((std::string(command) + " '" + path + "' > '" + path + ending + "'").c_str()), 0);
      Mesh mesh = read_all(*open_mesh(path + ending, {.properties = {"velocity:1", "T"}}));
      EXPECT_EQ(mesh, expected(true));
    }
  }
}

TEST(VtkReader, EveryPrefixIsAnErrorOrAPart) {
  const auto files = all_encodings(kTwoTetrahedra);
  for (const std::size_t i : {0u, 3u, 4u, 9u, 21u}) {
    SCOPED_TRACE(files[i].first);
    expect_prefixes_safe(files[i].first, files[i].second, 13);
  }
}

// What a cell of each type becomes, by its definition in the documentation of VTK.
TEST(VtkReader, AllTypesOfCells) {
  struct Case {
    int type;
    std::size_t nodes;
    std::size_t points, edges, triangles, tetrahedra;
    std::size_t kept;  // vertices
  };
  const std::vector<Case> cases = {
      {0, 0, 0, 0, 0, 0, 30},   {1, 1, 1, 0, 0, 0, 30},   {2, 4, 4, 0, 0, 0, 30},   {3, 2, 0, 1, 0, 0, 30},
      {4, 5, 0, 4, 0, 0, 30},   {5, 3, 0, 0, 1, 0, 30},   {6, 6, 0, 0, 4, 0, 30},   {7, 5, 0, 0, 3, 0, 30},
      {8, 4, 0, 0, 2, 0, 30},   {9, 4, 0, 0, 2, 0, 30},   {10, 4, 0, 0, 0, 1, 30},  {11, 8, 0, 0, 0, 6, 30},
      {12, 8, 0, 0, 0, 6, 30},  {13, 6, 0, 0, 0, 3, 30},  {14, 5, 0, 0, 0, 2, 30},  {21, 3, 0, 1, 0, 0, 29},
      {22, 6, 0, 0, 1, 0, 27},  {23, 8, 0, 0, 2, 0, 26},  {24, 10, 0, 0, 0, 1, 24}, {25, 20, 0, 0, 0, 6, 18},
      {26, 15, 0, 0, 0, 3, 21}, {27, 13, 0, 0, 0, 2, 22}, {28, 9, 0, 0, 2, 0, 25},  {29, 27, 0, 0, 0, 6, 11},
      {30, 6, 0, 0, 2, 0, 28},  {31, 12, 0, 0, 0, 3, 24}, {32, 18, 0, 0, 0, 3, 18}, {33, 24, 0, 0, 0, 6, 14},
      {34, 7, 0, 0, 1, 0, 26},  {35, 4, 0, 1, 0, 0, 28},  {36, 10, 0, 0, 3, 0, 25}, {37, 19, 0, 0, 0, 2, 16},
      {68, 6, 0, 1, 0, 0, 26},  {69, 10, 0, 0, 1, 0, 23}, {70, 16, 0, 0, 2, 0, 18}, {71, 20, 0, 0, 0, 1, 14},
      {72, 27, 0, 0, 0, 6, 11}, {73, 18, 0, 0, 0, 3, 18}, {74, 14, 0, 0, 0, 2, 21}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.type);
    VtkGrid grid;
    for (int i = 0; i < 30; ++i) grid.points.push_back({1.0 * i, 0, 0});
    VtkCell cell{c.type, {}};
    for (std::size_t i = 0; i < c.nodes; ++i) cell.nodes.push_back(static_cast<std::int64_t>(i));
    grid.cells = {cell};
    for (const std::string& path :
         {write_file("type.vtk", legacy_file(grid, {true, false})), write_file("type.vtu", xml_file(grid, {}))}) {
      const Mesh mesh = read_mesh(path);
      EXPECT_EQ(mesh.points.size(), c.points);
      EXPECT_EQ(mesh.edges.size(), c.edges);
      EXPECT_EQ(mesh.triangles.size(), c.triangles);
      // Hexahedra whose vertices are numbered as in 11 have six tetrahedra around a diagonal; others can have five.
      if (c.type == 12 || c.type == 25 || c.type == 29 || c.type == 33 || c.type == 72 || c.type == 11)
        EXPECT_GE(mesh.tetrahedra.size(), 5u);
      else
        EXPECT_EQ(mesh.tetrahedra.size(), c.tetrahedra);
      EXPECT_EQ(mesh.vertices.size(), c.kept);
    }
  }
}

TEST(VtkReader, InnerNodesThatAreCornersElsewhereStay) {
  VtkGrid grid;
  for (int i = 0; i < 8; ++i) grid.points.push_back({1.0 * i, 0, 0});
  // Vertex 7 is in no cell, so it stays; of the inner nodes 1, 2 and 5 only 2 is a corner of another cell.
  grid.cells = {{22, {0, 3, 4, 1, 2, 5}}, {3, {2, 6}}};
  grid.temperature = {0, 1, 2, 3, 4, 5, 6, 7};
  grid.velocity.assign(8, {0, 0, 0});
  for (const std::string& path :
       {write_file("inner.vtk", legacy_file(grid, {})), write_file("inner.vtu", xml_file(grid, {}))}) {
    const Mesh mesh = read_mesh(path, {"T"});
    std::vector<double> kept;
    for (const auto& vertex : mesh.vertices) {
      kept.push_back(vertex[0]);
      EXPECT_EQ(vertex[0], vertex[3]);
    }
    EXPECT_EQ(kept, (std::vector<double>{0, 2, 3, 4, 6, 7}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 2, 3}}));
    EXPECT_EQ(mesh.edges, (std::vector<std::vector<std::uint64_t>>{{1, 4}}));
    const auto reader = open_mesh(path);
    MeshBatch batch;
    while (reader->read(batch)) {
    }
    ASSERT_EQ(reader->warnings().size(), 1u);
    EXPECT_EQ(reader->warnings()[0], "2 nodes of higher-order cells, which are not corners, were left out");
  }
}

const VtkGrid kSquare = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 2}}, {}, {}, {}};

Mesh polydata() {
  Mesh mesh;
  for (const auto& point : kSquare.points) mesh.vertices.emplace_back(point.begin(), point.end());
  mesh.points = {{4}, {0}, {1}};
  mesh.edges = {{0, 1}, {1, 2}};
  mesh.triangles = {{3, 0, 1}, {3, 1, 2}, {0, 1, 2}, {2, 1, 3}};  // a fan from the first corner, then a strip
  return mesh;
}

TEST(VtkReader, PolyData) {
  for (const bool binary : {false, true}) {
    for (const bool offsets : {false, true}) {
      const LegacyStyle style{binary, offsets};
      const std::string text = legacy_head("POLYDATA", style) + legacy_points(kSquare, style, "float") +
                               legacy_cells("VERTICES", {{0, {4}}, {0, {0, 1}}}, style) +
                               legacy_cells("LINES", {{0, {0, 1, 2}}}, style) +
                               legacy_cells("POLYGONS", {{0, {3, 0, 1, 2}}}, style) +
                               legacy_cells("TRIANGLE_STRIPS", {{0, {0, 1, 2, 3}}}, style);
      const std::string path = write_file("poly.vtk", text);
      EXPECT_EQ(read_mesh(path), polydata());
      EXPECT_TRUE(open_mesh(path)->info().float32);
    }
  }
  for (const XmlStyle& style : xml_styles()) {
    XmlWriter writer(style);
    const std::string piece =
        "<Piece NumberOfPoints=\"5\" NumberOfVerts=\"2\" NumberOfLines=\"1\" NumberOfPolys=\"1\" "
        "NumberOfStrips=\"1\">\n"
        "<Points>\n" +
        writer.array("Float32", "Points", flat(kSquare.points), 3) + "</Points>\n<Verts>\n" +
        writer.array("Int32", "connectivity", {4, 0, 1}) + writer.array("Int32", "offsets", {1, 3}) +
        "</Verts>\n<Lines>\n" + writer.array("Int64", "connectivity", {0, 1, 2}) +
        writer.array("Int64", "offsets", {3}) + "</Lines>\n<Polys>\n" +
        writer.array("Int64", "connectivity", {3, 0, 1, 2}) + writer.array("Int64", "offsets", {4}) +
        "</Polys>\n<Strips>\n" + writer.array("Int64", "connectivity", {0, 1, 2, 3}) +
        writer.array("Int64", "offsets", {4}) + "</Strips>\n</Piece>\n";
    const Mesh mesh = read_mesh(write_file("poly.vtp", writer.file("PolyData", piece)));
    Mesh sorted = mesh, expected_mesh = polydata();
    std::ranges::sort(sorted.triangles);
    std::ranges::sort(expected_mesh.triangles);
    EXPECT_EQ(sorted, expected_mesh);
  }
}

TEST(VtkReader, PiecesFollowEachOther) {
  XmlWriter writer({});
  std::string pieces;
  for (const double shift : {0.0, 10.0})
    pieces += "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>" +
              writer.array("Float64", "Points", {shift, 0, 0, shift + 1, 0, 0, shift, 1, 0}, 3) + "</Points><Cells>" +
              writer.array("Int32", "connectivity", {0, 1, 2}) + writer.array("Int32", "offsets", {3}) +
              writer.array("UInt8", "types", {5}) + "</Cells></Piece>";
  pieces += "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>";
  const Mesh mesh = read_mesh(write_file("pieces.vtu", writer.file("UnstructuredGrid", pieces)));
  EXPECT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 1, 2}, {3, 4, 5}}));
}

// An array that changes is there once for each step. Arrays of bits hold no property.
TEST(VtkReader, OfSeveralTimeStepsTheFirstIsRead) {
  for (const auto coding : {XmlStyle::Coding::kText, XmlStyle::Coding::kAppendedBase64}) {
    XmlStyle style;
    style.coding = coding;
    XmlWriter writer(style);
    const auto steps = [&](const std::string& type, const std::string& name, int components,
                           const std::vector<std::vector<double>>& of_step) {
      std::string arrays;
      for (std::size_t step = 0; step < of_step.size(); ++step)
        arrays += writer.array(type, name + "\" TimeStep=\"" + std::to_string(step), of_step[step], components);
      return arrays;
    };
    const std::string piece =
        "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><PointData>" + writer.array("Bit", "b", {1}) +
        steps("Float64", "f", 1, {{1, 2, 3}, {4, 5, 6}}) + "</PointData><Points>" +
        steps("Float64", "Points", 3, {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {9, 9, 9, 8, 9, 9, 9, 8, 9}}) + "</Points><Cells>" +
        steps("Int32", "connectivity", 1, {{0, 1, 2}, {2, 1, 0}}) + writer.array("Int32", "offsets", {3}) +
        writer.array("UInt8", "types", {5}) + "</Cells></Piece>";
    const std::string path = write_file("steps.vtu", writer.file("UnstructuredGrid", piece));
    const Mesh mesh = read_mesh(path, {"f"});
    EXPECT_EQ(mesh.vertices, (std::vector<std::vector<double>>{{0, 0, 0, 1}, {1, 0, 0, 2}, {0, 1, 0, 3}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 1, 2}}));
    const auto reader = open_mesh(path);
    EXPECT_EQ(reader->info().property_names, std::vector<std::string>{"f"});
    EXPECT_EQ(reader->warnings(),
              std::vector<std::string>{"the file has several time steps; only the first one was read"});
  }
}

TEST(VtkReader, IntegersThatAreRoundedAreCounted) {
  const std::string head =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 1 1 0\n"
      "POINT_DATA 4\nSCALARS id vtktypeint64 1\nLOOKUP_TABLE default\n";
  const auto notes = [&](const std::string& values) {
    const auto reader = open_mesh(write_file("ids.vtk", head + values), {.properties = {"id"}});
    read_all(*reader);
    return reader->warnings();
  };
  EXPECT_EQ(notes("9007199254740992 -9007199254740992 1 9007199254740994\n"), std::vector<std::string>());
  EXPECT_EQ(notes("9007199254740993 -9007199254740993 1 9223372036854775807\n"),
            std::vector<std::string>{"3 values beyond 2^53 were rounded to the nearest double"});
}

TEST(VtkReader, NumbersAreFloat32OnlyIfThoseOfPropertiesAre) {
  for (const auto& [type, is_float32] :
       {std::pair("Float32", true), {"UInt8", true}, {"Float64", false}, {"Int32", false}}) {
    XmlWriter writer({});
    const std::string piece = "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><PointData>" +
                              writer.array(type, "f", {1}) + "</PointData><Points>" +
                              writer.array("Float32", "Points", {0, 0, 0}, 3) + "</Points></Piece>";
    EXPECT_EQ(open_mesh(write_file("types.vtu", writer.file("UnstructuredGrid", piece)))->info().float32, is_float32)
        << type;
  }
}

// VTK writes such elements into arrays of newer files.
TEST(VtkReader, ElementsInAnArrayArePassedOver) {
  const std::string key =
      "<InformationKey name=\"L2\" location=\"vtkDataArray\"><Value index=\"0\">7</Value></InformationKey>";
  for (const bool before : {false, true}) {
    std::string text = xml_file(kTwoTetrahedra, {});
    for (std::size_t at = 0; (at = text.find(before ? "\">\n" : "</DataArray>", at)) != std::string::npos;) {
      at += before ? 2 : 0;
      const std::size_t begin = text.rfind('<', at - 1);
      if (!before || text.compare(begin, 10, "<DataArray") == 0) text.insert(at, key), at += key.size();
      at += 2;
    }
    EXPECT_EQ(read_mesh(write_file("keys.vtu", text), {"velocity:1", "T"}), expected(true));
  }
}

TEST(VtkReader, AsciiNumbersHaveTheDeclaredType) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 ";
  EXPECT_EQ(read_mesh(write_file("f.vtk", head + "float\n0.1 -0 0\n")).vertices[0][0], static_cast<double>(0.1F));
  EXPECT_EQ(read_mesh(write_file("d.vtk", head + "double\n0.1 -0 0\n")).vertices[0][0], 0.1);
}

TEST(VtkReader, OddPartsOfLegacyFiles) {
  const std::string text =
      "# vtk DataFile Version 4.2\nt\nASCII\nFIELD FieldData 2\nTIME 1 1 double\n0.5\nnames 1 2 string\none\ntwo%20\n"
      "DATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0\n0 0 1 0\nMETADATA\nINFORMATION 1\nNAME L2 LOCATION "
      "vtkDataArray\nDATA 2 0 1\n\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n\nPOINT_DATA 3\nSCALARS my%20name double 2\n"
      "LOOKUP_TABLE own\n1 2 3 4 5 nan\nLOOKUP_TABLE own 1\n0 0 0 1\nCOLOR_SCALARS c 3\n1 1 1 1 1 1 1 1 1\nVECTORS v "
      "float\n"
      "1 2 3 4 5 6 7 8 9\nTEXTURE_COORDINATES t 2 float\n1 2 3 4 5 6\nTENSORS w float\n1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 "
      "8 "
      "9 1 2 3 4 5 6 7 8 9\nCELL_DATA 1\nSCALARS s int\nLOOKUP_TABLE default\n4\n";
  const std::string path = write_file("odd.vtk", text);
  const Mesh mesh = read_mesh(path, {"my name:0", "v:2", "t:1"});
  EXPECT_EQ(mesh.vertices[1], (std::vector<double>{1, 0, 0, 3, 6, 4}));
  EXPECT_EQ(mesh.triangles.size(), 1u);
  expect_bad(path, "27:11", "not finite", {.properties = {"my name:1"}});
}

TEST(VtkReader, ANumberThatIsTooLongIsRefused) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 double\n0 ";
  const std::string longest = "0." + std::string(4093, '1');
  EXPECT_NEAR(read_mesh(write_file("long.vtk", head + longest + " 0\n")).vertices.at(0).at(1), 1.0 / 9, 1e-15);
  expect_bad(write_file("longer.vtk", head + longest + "1 0\n"), "6:3", "more than 4096 characters");
  expect_bad(write_file("longer.vtk", head + longest + longest + " 0\n"), "6:3", "more than 4096 characters");
}

// Values for no point would be those of the points that follow.
TEST(VtkReader, ValuesBeforeThePointsAreRefused) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINT_DATA 0\n";
  for (const std::string values : {"SCALARS s double\nLOOKUP_TABLE default\n", "FIELD f 1\ns 1 0 double\n"})
    expect_bad(write_file("before.vtk", head + values + "POINTS 1 double\n0 0 0\n"), "8:1",
               "POINT_DATA cannot come before POINTS");
}

// A packed file is not unpacked from its beginning again for each array of each piece.
TEST(VtkReader, ManyPiecesOfAPackedFileTakeLittleTime) {
  constexpr std::size_t kPieces = 3000;
  XmlWriter writer({});
  std::string pieces;
  for (std::size_t i = 0; i < kPieces; ++i)
    pieces += "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>" +
              writer.array("Float64", "Points", {static_cast<double>(i), 0, 0, 1, 0, 0, 0, 1, 0}, 3) +
              "</Points><Cells>" + writer.array("Int32", "connectivity", {0, 1, 2}) +
              writer.array("Int32", "offsets", {3}) + writer.array("UInt8", "types", {5}) + "</Cells></Piece>\n";
  const std::string path = write_file("many_pieces.vtu", writer.file("UnstructuredGrid", pieces));
  ASSERT_EQ(std::system(("gzip -c '" + path + "' > '" + path + ".gz'").c_str()), 0);
  const auto seconds_to_read = [&](const std::string& file) {
    const std::clock_t start = std::clock();
    const auto reader = open_mesh(file, {.properties = {}, .temp_folder = scratch_folder().string()});
    EXPECT_EQ(reader->info().file_bytes, std::filesystem::file_size(file));
    const Mesh mesh = read_all(*reader);
    EXPECT_EQ(mesh.triangles.size(), kPieces);
    EXPECT_EQ(mesh.vertices.at(3 * (kPieces - 1)).at(0), static_cast<double>(kPieces - 1));
    EXPECT_LE(reader->bytes_read(), std::filesystem::file_size(file));
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double plain = seconds_to_read(path);
  EXPECT_LT(seconds_to_read(path + ".gz"), 3 * plain + 1);
}

// Bytes that this process got from the system so far; nothing if the system does not count them.
std::optional<std::uint64_t> bytes_from_system() {
  std::ifstream counts("/proc/self/io");
  std::string name;
  std::uint64_t bytes = 0;
  if (!(counts >> name >> bytes) || name != "rchar:") return std::nullopt;
  return bytes;
}

TEST(VtkReader, BytesOfAnArrayAreReadOnce) {
  VtkGrid grid;
  grid.points.assign(300000, {1, 2, 3});
  const std::string path = write_file("once.vtk", legacy_file(grid, {.binary = true}));
  const auto before = bytes_from_system();
  if (!before) GTEST_SKIP() << "no /proc/self/io";
  EXPECT_EQ(read_all(*open_mesh(path)).vertices.size(), 300000u);
  EXPECT_LT(*bytes_from_system() - *before, 2 * std::filesystem::file_size(path));
}

std::string with(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return at == std::string::npos ? text : text.replace(at, old_part.size(), new_part);
}

TEST(VtkReader, BadLegacyFiles) {
  const std::string good =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
      "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
  EXPECT_EQ(read_mesh(write_file("good.vtk", good)).triangles.size(), 1u);
  const auto bad = [&](const std::string& before, const std::string& after, const std::string& position,
                       const std::string& words) {
    expect_bad(write_file("bad.vtk", with(good, before, after)), position, words);
  };
  bad("0 0 0 1", "0 nan 0 1", "6:3", "not finite");
  bad("CELLS 1", "POINTS 1 float\n0 0 0\nCELLS 1", "7:1", "POINTS twice");
  bad("CELL_TYPES 1", "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1", "9:1", "CELLS twice");
  bad("0 0 0 1", "0 x 0 1", "6:3", "cannot be \"x\"");
  bad("3 0 1 2", "3 0 1 3", "8:7", "names point 3");
  bad("3 0 1 2", "3 0 1 -1", "8:7", "names point -1");
  bad("3 0 1 2", "4 0 1 2", "8:1", "a cell has 4 nodes");
  bad("3 0 1 2", "2 0 1 2", "10:1", "cannot have 2 nodes");
  bad("CELLS 1 4", "CELLS 1 5", "9:12", "does not belong here");
  bad("POINTS 3", "POINTS 30000000000", "5:20", "more than it has room for");
  bad("POINTS 3", "POINTS 99999999999999999999", "5:8", "number of points");
  bad("CELL_TYPES 1\n5", "CELL_TYPES 1\n42", "10:1", "polyhedron");
  bad("CELL_TYPES 1\n5", "CELL_TYPES 1\n99", "10:1", "type 99");
  bad("CELL_TYPES 1", "CELL_TYPES 0", "10:1", "");
  bad("UNSTRUCTURED_GRID", "RECTILINEAR_GRID", "4:9", "RECTILINEAR_GRID is not read");
  bad("ASCII", "ASCI", "3:1", "ASCII or BINARY");
  expect_bad(write_file("good.vtk", good), "", "no vertex property", {.properties = {"T"}});
}

TEST(VtkReader, BadXmlFiles) {
  const std::string good = xml_file(kTwoTetrahedra, {});
  const auto bad = [&](const std::string& before, const std::string& after, const std::string& words,
                       const std::vector<std::string>& properties = {}) {
    SCOPED_TRACE(before + " -> " + after);
    expect_bad(write_file("bad.vtu", with(good, before, after)), std::nullopt, words, {.properties = properties});
  };
  bad("NumberOfPoints=\"5\"", "NumberOfPoints=\"500000000\"", "more than it has room for");
  bad("NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"", "array ends where a coordinate");
  bad("NumberOfPoints=\"5\"", "NumberOfPoints=\"4\"", "names point 4");
  bad("NumberOfPoints=\"5\"", "NumberOfPoints=\"x\"", "NumberOfPoints is not a count");
  bad("NumberOfCells=\"5\"", "NumberOfCells=\"6\"", "array ends where a cell type");
  bad("byte_order=\"LittleEndian\"", "byte_order=\"Odd\"", "which is not read");
  bad(">\n<UnstructuredGrid>", " compressor=\"vtkLZMADataCompressor\">\n<UnstructuredGrid>", "packed by vtkLZMA");
  bad("Name=\"types\"", "Name=\"kinds\"", "not all arrays");
  bad("Name=\"types\"", "Name=types", "not valid XML");
  bad("format=\"ascii\">", "format=\"appended\" offset=\"0\">", "no element AppendedData");
  bad("</VTKFile>", "", "not valid XML: no element found");
  bad("4\n8\n11\n13\n14", "4\n3\n11\n13\n14", "before the cell before it");
  bad("4\n8\n11\n13\n14", "4\n8\n11\n13\n15", "cannot have 2 nodes");
  bad("0\n1\n2\n0\n4\n2\n", "0\n1\n2\n0\n4\n", "array ends where a point number");
  bad("-5\n", "nan\n", "not finite", {"T"});
  bad("Name=\"T\"", "Name=\"U\"", "no vertex property \"T\"", {"T"});
  bad("Name=\"velocity\"", "Name=\"velocity\"", "no vertex property \"velocity\"", {"velocity"});
}

// A packed file of some kilobytes can list millions of entries.
TEST(VtkReader, WhatAFileListsHasALimit) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n";
  std::string sections, arrays;
  for (int i = 0; i < 10000; ++i) sections += "VERTICES 1 2\n1 0\n";
  EXPECT_EQ(read_all(*open_mesh(write_file("most.vtk", head + sections))).points.size(), 10000u);
  expect_bad(write_file("many.vtk", head + sections + "VERTICES 1 2\n1 0\n"), "20007:1",
             "more than 10,000 lists of cells");
  // Of 65 components, 64 are properties with names.
  std::string values;
  for (int i = 0; i < 65; ++i) values += "0 ";
  for (int i = 0; i < 157; ++i) arrays += "a" + std::to_string(i) + " 65 1 float\n" + values + "\n";
  expect_bad(write_file("arrays.vtk", head + "POINT_DATA 1\nFIELD f 157\n" + arrays), std::nullopt,
             "more than 10,000 properties");

  const std::string piece = "<Piece NumberOfPoints=\"0\"/>\n";
  const auto poly = [](const std::string& inside) {
    return "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\">\n<PolyData>\n" + inside +
           "</PolyData>\n</VTKFile>\n";
  };
  std::string pieces;
  for (int i = 0; i < 10000; ++i) pieces += piece;
  EXPECT_EQ(read_mesh(write_file("most.vtp", poly(pieces))), Mesh());
  expect_bad(write_file("pieces.vtp", poly(pieces + piece)), "10003:1", "more than 10,000 pieces");

  const auto nested = [&](std::size_t depth) {
    std::string tags;
    for (std::size_t i = 0; i < depth; ++i) tags += "<a>";
    for (std::size_t i = 0; i < depth; ++i) tags += "</a>";
    return poly(tags + piece);
  };
  EXPECT_EQ(read_mesh(write_file("nested.vtp", nested(98))), Mesh());
  expect_bad(write_file("nested.vtp", nested(99)), "3:295", "more than 100 tags inside each other");

  std::string names;
  for (int i = 0; i < 10000; ++i) names += "<t" + std::to_string(i) + "/>\n";
  expect_bad(write_file("names.vtp", poly(names + piece)), std::nullopt,
             "more than 10,000 different names of tags and attributes");
}

TEST(VtkReader, DamagedPackedArrays) {
  Mesh undamaged = expected(false);
  for (std::size_t i = 0; i < undamaged.vertices.size(); ++i)
    undamaged.vertices[i].push_back(kTwoTetrahedra.temperature[i]);
  for (const XmlStyle& style : xml_styles()) {
    if (style.compressor.empty() || style.coding != XmlStyle::Coding::kAppendedRaw) continue;
    const std::string good = xml_file(kTwoTetrahedra, style);
    const std::size_t offset = good.find("offset=\"", good.find("Name=\"T\"")) + 8;
    const std::size_t begin = good.find(" _") + 2 + std::stoul(good.substr(offset));
    const bool has_checksum = style.compressor == "ZLib";
    std::size_t refused = 0;
    // Each byte of the header of the array T, and of its first block.
    for (std::size_t at = begin; at < begin + 40; ++at) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
      try {
        const Mesh mesh = read_all(*open_mesh(write_file("damaged.vtu", bytes), {.properties = {"T"}}));
        if (has_checksum) {
          EXPECT_EQ(mesh, undamaged) << "byte " << at - begin;
        }
      } catch (const Error& error) {
        ++refused;
        EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
        EXPECT_FALSE(error.hint().empty());
        EXPECT_FALSE(error.position().empty());
      }
    }
    // Without a checksum, values in the block can change unseen.
    EXPECT_GT(refused, has_checksum ? 20u : 8u) << style.compressor;
  }
}

}  // namespace
}  // namespace reeb::io::testing
