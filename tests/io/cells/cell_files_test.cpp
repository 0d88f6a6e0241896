// MSH, Medit and TetGen files written by hand, in every version and encoding, and bad ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "io/file/content_source.h"
#include "io/formats/open_input.h"
#include "libreeb/base/error.h"
#include "tests/io/cells/cell_files.h"

namespace reeb::io::testing {
namespace {

Mesh expected(bool with_points = true, bool with_values = false) {
  Mesh mesh;
  for (const Point& point : kPoints) {
    auto& vertex = mesh.vertices.emplace_back(point.begin(), point.end());
    if (with_values) vertex.push_back(10 + 2 * static_cast<double>(mesh.vertices.size()));
  }
  if (with_points) mesh.points = {{2}};
  mesh.edges = {{0, 4}};
  mesh.triangles = {{0, 1, 2}};
  mesh.tetrahedra = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  return mesh;
}

TEST(CellFiles, MshOfEveryKindGivesTheSameMesh) {
  for (const auto& [name, bytes] : {std::pair("4a.msh", msh4(false)),
                                    {"4b.msh", msh4(true)},
                                    {"4c.msh", msh4(true, true)},
                                    {"2a.msh", msh2(false)},
                                    {"2b.msh", msh2(true)},
                                    {"2c.msh", msh2(true, true)}}) {
    SCOPED_TRACE(name);
    const std::string path = write_file(name, bytes);
    EXPECT_EQ(read_mesh(path), expected());
    EXPECT_EQ(read_mesh(path, {"a name:1"}), expected(true, true));
    const auto info = open_mesh(path)->info();
    EXPECT_EQ(info.vertex_count, 5u);
    EXPECT_EQ(info.simplex_count, 5u);
    EXPECT_EQ(info.property_names, (std::vector<std::string>{"a name:0", "a name:1"}));
    ASSERT_EQ(std::system(("gzip -c '" + path + "' > '" + path + ".gz'").c_str()), 0);
    EXPECT_EQ(read_mesh(path + ".gz", {"a name:1"}), expected(true, true));
    expect_prefixes_safe(name, bytes, 5);
  }
}

TEST(CellFiles, MshOfHigherOrder) {
  std::vector<Point> points;
  for (int i = 0; i < 11; ++i) points.push_back({1.0 * i, 0, 0});
  // Node 9 is inside the tetrahedron of ten nodes, and the end of a line; node 10 is in nothing.
  const std::vector<Element> elements = {{11, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}}, {1, {0, 9}}};
  for (const bool binary : {false, true}) {
    const Mesh mesh = read_mesh(write_file("high.msh", msh4(binary, false, points, elements)));
    std::vector<double> kept;
    for (const auto& vertex : mesh.vertices) kept.push_back(vertex[0]);
    EXPECT_EQ(kept, (std::vector<double>{0, 1, 2, 3, 9, 10}));
    EXPECT_EQ(mesh.tetrahedra, (std::vector<std::vector<std::uint64_t>>{{0, 1, 2, 3}}));
    EXPECT_EQ(mesh.edges, (std::vector<std::vector<std::uint64_t>>{{0, 4}}));
  }
}

TEST(CellFiles, MshDividesCells) {
  std::vector<Point> points;
  for (int i = 0; i < 8; ++i) points.push_back({1.0 * i, 0, 0});
  const std::vector<Element> elements = {
      {3, {3, 1, 0, 2}}, {5, {0, 1, 3, 2, 4, 5, 7, 6}}, {6, {0, 1, 2, 3, 4, 5}}, {7, {0, 1, 2, 3, 4}}};
  const Mesh mesh = read_mesh(write_file("cells.msh", msh4(false, false, points, elements)));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 2, 3}, {0, 3, 1}}));
  EXPECT_EQ(mesh.tetrahedra.size(), 6u + 3 + 2);
}

std::string with(std::string text, const std::string& old_part, const std::string& new_part) {
  const std::size_t at = text.find(old_part);
  EXPECT_NE(at, std::string::npos) << old_part;
  return at == std::string::npos ? text : text.replace(at, old_part.size(), new_part);
}

// The line and column of the character `skip` after the beginning of `context`.
std::string place(const std::string& text, const std::string& context, std::size_t skip) {
  const std::size_t at = text.find(context) + skip;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  const std::size_t begin = text.rfind('\n', at - 1) + 1;
  return std::to_string(line) + ":" + std::to_string(at - begin + 1);
}

TEST(CellFiles, BadMsh) {
  const std::string good = msh2(false);
  const auto bad = [&](const std::string& before, const std::string& after, std::size_t skip, const std::string& words,
                       const ReadOptions& options = {}) {
    const std::string text = with(good, before, after);
    expect_bad(write_file("bad.msh", text), place(text, after, skip), words, options);
  };
  bad("2.2 0 8", "1.0 0 8", 0, "MSH version 1.0");
  bad("2.2 0 8", "4 0 8", 0, "MSH version 4");
  bad("55 4 2 0 1 7 8 3 100", "55 4 2 0 1 7 8 3 99", 17, "names node 99");
  bad("55 4 2", "55 34 2", 3, "type 34");
  bad("100 0 0 1", "100 0 inf 1", 6, "coordinate");
  bad("100 0 0 1 \n12 0.1 1 1 \n$EndNodes", "100 0 0 1 \n100 0.1 1 1 \n$EndNodes", 24, "same tag");
  bad("$EndElements\n$NodeData", "$NodeData", 0, "does not end here");
  bad("7 5 12", "8 5 12", 0, "do not list node 7", {.properties = {"a name:0"}});
  bad("7 5 12", "7 nan 12", 2, "vertex property", {.properties = {"a name:0"}});
  expect_bad(write_file("good.msh", good), "", "no vertex property \"a name\"", {.properties = {"a name"}});
}

TEST(CellFiles, Medit) {
  const std::string path = write_file("a.mesh", medit());
  EXPECT_EQ(read_mesh(path), expected(false));
  EXPECT_FALSE(open_mesh(path)->info().float32);
  ASSERT_EQ(std::system(("gzip -c '" + path + "' > '" + path + ".gz'").c_str()), 0);
  EXPECT_EQ(read_mesh(path + ".gz"), expected(false));
  expect_prefixes_safe("a.mesh", medit(), 3);
  const Mesh rounded = read_mesh(write_file("f.mesh", medit("1")));
  EXPECT_EQ(rounded.vertices[4][0], static_cast<double>(0.1F));
  const Mesh plane = read_mesh(write_file(
      "plane.mesh",
      "MeshVersionFormatted 2 Dimension 2\nVertices 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\nQuadrilaterals 1\n4 3 2 1 0\n"
      "End\n"));
  EXPECT_EQ(plane.vertices[2], (std::vector<double>{1, 1}));
  EXPECT_EQ(plane.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 3, 2}, {0, 2, 1}}));
}

TEST(CellFiles, SectionsOfMeditBeginAnywhere) {
  const std::string lines = medit().substr(medit().find('\n') + 1);  // the first one is a comment
  for (const char end : {' ', '\r'}) {
    std::string text = lines;
    std::ranges::replace(text, '\n', end);
    EXPECT_EQ(read_mesh(write_file("line.mesh", text)), expected(false));
  }
  const std::string head = "MeshVersionFormatted 2\nDimension 3\nVertices 3 0 0 0 1 1 1e0 2E+1 1 # Edges 1\n 3 3 3 1";
  for (std::string blanks : {std::string(" "), std::string(5000, ' '), std::string("\n\n")}) {
    const Mesh mesh = read_mesh(write_file("middle.mesh", head + blanks + "Ridges 1 1 Triangles 1 3 1 2 0" + blanks));
    EXPECT_EQ(mesh.vertices.size(), 3u);
    EXPECT_TRUE(mesh.edges.empty());
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{2, 0, 1}}));
  }
}

TEST(CellFiles, WhatIsLeftOutOfMeditIsNoted) {
  const auto notes = [](const std::string& sections) {
    const auto reader = open_mesh(
        write_file("notes.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices 3\n0 0 0\n1 0 0\n1 1 0\n" + sections));
    read_all(*reader);
    return reader->warnings();
  };
  using Notes = std::vector<std::string>;
  EXPECT_EQ(notes("Corners 1\n1\nTriangles 1\n1 2 3 0\nEnd\n"), Notes());
  EXPECT_EQ(notes("Triangel 1\n1 2 3 0\nEnd\n"),
            Notes{"1 section with a name that is not known was ignored; the first is \"Triangel\""});
  EXPECT_EQ(notes("Triangles 1\n1 2 3 0\n1 2 3 0\nEdges 0\nTri"),
            (Notes{"1 section with a name that is not known was ignored; the first is \"Tri\"",
                   "records after the announced number were ignored, in 1 section"}));
}

TEST(CellFiles, SurplusLinesOfTetgenAreNoted) {
  const auto notes = [](const std::string& nodes, const std::string& cells) {
    write_file("surplus.node", nodes);
    const auto reader = open_mesh(write_file("surplus.ele", cells));
    read_all(*reader);
    return reader->warnings();
  };
  const std::string nodes = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", cells = "1 4 0\n1 1 2 3 4\n";
  const std::vector<std::string> note = {"lines after the announced number of vertices or cells were ignored"};
  EXPECT_EQ(notes(nodes + "# by hand\n", cells + "\n# by hand\n"), std::vector<std::string>());
  EXPECT_EQ(notes(nodes + "5 1 1 1\n", cells), note);
  EXPECT_EQ(notes(nodes, cells + "2 1 2 3 4\n"), note);
}

TEST(CellFiles, MeditOfHigherOrder) {
  const Mesh mesh =
      read_mesh(write_file("high.mesh",
                           "MeshVersionFormatted 2\nDimension 2\nVertices 7\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 "
                           "0\n5 0 0\n6 0 0\nTrianglesP2 1\n7 1 2 3 4 5 0\nEnd\n"));
  EXPECT_EQ(mesh.vertices, (std::vector<std::vector<double>>{{0, 0}, {1, 0}, {5, 0}, {6, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint64_t, 3>>{{3, 0, 1}}));
}

TEST(CellFiles, BadMedit) {
  const auto bad = [&](const std::string& before, const std::string& after, std::size_t skip,
                       const std::string& words) {
    const std::string text = with(medit(), before, after);
    expect_bad(write_file("bad.mesh", text), place(text, after, skip), words);
  };
  bad("2 3 4 5 0", "2 3 4 6 0", 6, "names vertex 6");
  bad("2 3 4 5 0", "2 3 4 0 0", 6, "names vertex 0");
  bad("1 0 0.5", "1 0 nan", 4, "coordinate");
  bad("Vertices\n5", "Vertices\n500000", 9, "more than it has room for");
  expect_bad(write_file("none.mesh", "MeshVersionFormatted 2\nDimension 3\nEnd\n"), "3:4", "no section of vertices");
  bad("Formatted 2", "Formatted 9", 10, "Medit version 9");
  bad("Dimension\n3", "Dimension\n4", 10, "of dimension 4");
  bad("Dimension\n3", "Dimension\n4294967299", 10, "of dimension 4294967299");
  bad("Dimension\n3", "Dimension\n3\nDimension\n2", 22, "two dimensions");
}

// A packed file of some kilobytes can list millions of entries.
TEST(CellFiles, WhatAFileListsHasALimit) {
  std::string sections, arrays;
  for (int i = 0; i < 10000; ++i) sections += "Edges 1\n1 1 0\n";
  const std::string medit_head = "MeshVersionFormatted 2\nDimension 3\nVertices 1\n0 0 0 0\n";
  EXPECT_EQ(read_all(*open_mesh(write_file("most.mesh", medit_head + sections + "End\n"))).edges.size(), 10000u);
  expect_bad(write_file("many.mesh", medit_head + sections + "Edges 1\n1 1 0\nEnd\n"), std::nullopt,
             "more than 10,000 sections of cells");
  for (int i = 0; i < 10000; ++i) arrays += "$NodeData\n1\n\"a\"\n0\n3\n0\n1\n0\n$EndNodeData\n";
  const std::string msh_head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n";
  EXPECT_EQ(open_mesh(write_file("most.msh", msh_head + arrays))->info().property_names.size(), 10000u);
  expect_bad(write_file("many.msh", msh_head + arrays + "$NodeData\n1\n\"a\"\n0\n3\n0\n1\n0\n$EndNodeData\n"),
             std::nullopt, "more than 10,000 properties");
  write_file("most.node", "0 3 10000 0\n");
  EXPECT_EQ(open_mesh(write_file("most.ele", "0 4 0\n"))->info().property_names.size(), 10000u);
  const std::string nodes = write_file("many.node", "0 3 10001 0\n"), cells = write_file("many.ele", "0 4 0\n");
  try {
    open_mesh(cells);
    ADD_FAILURE() << "was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), nodes);
    EXPECT_EQ(error.position(), "1:5");
    EXPECT_NE(error.message().find("more than 10,000 properties"), std::string::npos) << error.what();
  }
}

// Tags are not compared after each section.
TEST(CellFiles, ManySectionsOfNodesTakeLittleTime) {
  constexpr std::size_t kSections = 30000;
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  const auto section = [](std::size_t tag) { return "$Nodes\n1\n" + std::to_string(tag) + " 0 0 0\n$EndNodes\n"; };
  std::string sections;
  for (std::size_t i = 0; i < kSections; ++i) sections += section(2 * (kSections - i));
  const std::string path = write_file("sections.msh", head + sections);
  const std::clock_t start = std::clock();
  EXPECT_EQ(read_all(*open_mesh(path)).vertices.size(), kSections);
  EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 5);
  for (const std::size_t nodes : {1u, 2u, 3u, 5u, 6u, 7u, 12u}) {
    std::string repeated = head;
    for (std::size_t i = 0; i < nodes; ++i) repeated += section(i + 1);
    EXPECT_EQ(read_all(*open_mesh(write_file("differ.msh", repeated))).vertices.size(), nodes);
    expect_bad(write_file("repeat.msh", repeated + section(1)), std::nullopt, "same tag");
  }
}

// All components come from one reading of the array, whose memory counts.
TEST(CellFiles, ComponentsOfAnArrayOfMshShareItsReading) {
  const std::string path = write_file("share.msh", msh4(false));
  const auto memory = [&](const std::vector<std::string>& properties) {
    const auto reader = open_mesh(path, {.properties = properties});
    Mesh mesh = read_all(*reader);
    EXPECT_EQ(mesh.vertices.size(), kPoints.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
      for (std::size_t k = 0; k < properties.size(); ++k)
        EXPECT_EQ(mesh.vertices[i].at(3 + k), properties[k] == "a name:0" ? 5 : 12 + 2 * static_cast<double>(i));
    return reader->memory_bytes();
  };
  EXPECT_GT(memory({"a name:0"}), memory({}));
  EXPECT_EQ(memory({"a name:1", "a name:0"}), memory({"a name:0"}));
}

// The caller can look at the memory of tags before all of a block were read.
TEST(CellFiles, TagsOfNodesCountAsMemory) {
  constexpr std::size_t kNodes = 300000;
  std::string tags, points;
  for (std::size_t i = 0; i < kNodes; ++i) {
    tags += std::to_string(2 * (kNodes - i)) + "\n";
    points += "0 0 0\n";
  }
  const std::string count = std::to_string(kNodes);
  const auto reader =
      open_mesh(write_file("tags.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 " + count +
                                           " 1 600000\n2 1 0 " + count + "\n" + tags + points + "$EndNodes\n"));
  EXPECT_LT(reader->memory_bytes(), 1000u);
  MeshBatch batch;
  ASSERT_TRUE(reader->read(batch));
  EXPECT_TRUE(batch.empty());
  EXPECT_GT(reader->memory_bytes(), 1000000u);
  EXPECT_LT(reader->memory_bytes(), 24 * kNodes);
  std::size_t vertices = 0;
  while (reader->read(batch)) vertices += batch.vertex_count;
  EXPECT_EQ(vertices, kNodes);
  EXPECT_GE(reader->memory_bytes(), 24 * kNodes);
}

TEST(CellFiles, TetGen) {
  for (const std::uint64_t first : {0u, 1u}) {
    Mesh mesh = expected(false);
    mesh.edges.clear();
    mesh.triangles.clear();
    write_file("t.node", tetgen_nodes(first));
    const std::string path = write_file("t.ele", tetgen_cells(first));
    EXPECT_EQ(read_mesh(path), mesh);
    EXPECT_EQ(read_mesh(path, {"attribute:1"}).vertices, expected(false, true).vertices);
    const std::string faces = std::to_string(first) + " " + std::to_string(first) + " " + std::to_string(first + 1) +
                              " " + std::to_string(first + 2) + " -1\n";
    const Mesh skin = read_mesh(write_file("t.face", "1 1\n" + faces));
    EXPECT_EQ(skin.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 1, 2}}));
    ASSERT_EQ(std::system(("gzip -c '" + path + "' > '" + path + ".gz'").c_str()), 0);
    EXPECT_EQ(read_mesh(path + ".gz"), mesh);
  }
  write_file("plane.node", "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n");
  const Mesh plane = read_mesh(write_file("plane.ele", "1 3 0\n1 1 2 3\n"));
  EXPECT_EQ(plane.triangles, (std::vector<std::array<std::uint64_t, 3>>{{0, 1, 2}}));
  std::string nodes = "11 3\n";
  for (int i = 0; i < 11; ++i) nodes += std::to_string(i) + " " + std::to_string(i) + " 0 0\n";
  write_file("high.node", nodes);
  const Mesh high = read_mesh(write_file("high.ele", "1 10 0\n0 0 1 2 3 4 5 6 7 8 9\n"));
  EXPECT_EQ(high.vertices.size(), 5u);
  EXPECT_EQ(high.tetrahedra, (std::vector<std::vector<std::uint64_t>>{{0, 1, 2, 3}}));
}

// The vertices are in another file, which must not change either.
TEST(CellFiles, AChangeOfTheVerticesOfTetGenIsNoticed) {
  for (const std::string ending : {"ele", "face"}) {
    const std::string nodes = write_file("w.node", tetgen_nodes());
    const std::string cells = write_file("w." + ending, ending == "ele" ? tetgen_cells() : "1 1\n0 0 1 2 -1\n");
    const Input input = mesh_input(cells), named = mesh_input(cells, "tetgen"), other = mesh_input(cells, "ply");
    input.check_unchanged();
    write_file("w.node", tetgen_nodes() + "# more\n");
    EXPECT_THROW(input.check_unchanged(), Error) << "written to";
    EXPECT_THROW(named.check_unchanged(), Error);
    other.check_unchanged();
    const Input replaced = mesh_input(cells);
    replaced.check_unchanged();
    std::filesystem::rename(write_file("w.new", tetgen_nodes()), nodes);
    EXPECT_THROW(replaced.check_unchanged(), Error) << "replaced";
    const Input same = mesh_input(cells);
    std::filesystem::rename(write_file("w.new", ""), cells);
    EXPECT_THROW(same.check_unchanged(), Error) << "the cells";
  }
}

TEST(CellFiles, BadTetGen) {
  write_file("b.node", tetgen_nodes());
  expect_bad(write_file("b.ele", with(tetgen_cells(), "1 1 2 3 4", "1 1 2 3 5")), "3:9", "names vertex 5");
  expect_bad(write_file("b.ele", with(tetgen_cells(), "1 1 2 3 4", "1 1 2 3 -9223372036854775808")), "3:9",
             "names vertex -9223372036854775808");
  expect_bad(write_file("b.ele", with(tetgen_cells(), "2 4 1", "3 4 1")), "5:1", "file ends");
  expect_bad(write_file("b.ele", with(tetgen_cells(), "2 4 1", "2 5 1")), "1:3", "cells of 5 nodes");
  expect_bad(write_file("b.ele", with(tetgen_cells(), "2 4 1", "20000 4 1")), "1:7", "more than it has room for");
  expect_bad(write_file("alone.ele", tetgen_cells()), "", "there is no file");
  expect_bad(write_file("alone.node", tetgen_nodes()), "", "only the vertices");
}

}  // namespace
}  // namespace reeb::io::testing
