// Exporters against files written by hand.
#include "io/export/graph_export.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <utility>

#include "io/export/graph_lines.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// A circle, and an isolated vertex. The circle is two arcs from vertex 7 to vertex 3. One arc has two buckets, of which
// one is empty.
struct Circle {
  ReebGraph graph;
  ArcBuckets buckets;
  Circle() {
    const SweepKey lo{-0.0, VertexId(7)}, hi{1.5, VertexId(3)}, point{0.1, VertexId(9)};
    graph = make_graph({{lo, hi}, {lo, hi}}, {point});
    graph.positions = {{0, 0, 0}, {4, 4, 4}, {0, 0, 1.5}};
    buckets.offsets = {0, 2, 2};
    buckets.buckets = {{0, 3, {1, 0.5, -0.0}}, {1, 0, {}}};
  }
  std::string text(const char* format) const {
    std::ostringstream out;
    write_graph(*graph_format(format), {graph, "a \"b\"", 0.25, buckets.view(), -2}, out);
    return out.str();
  }
};

TEST(GraphExport, Rg) {
  EXPECT_EQ(Circle().text("rg"),
            "n 7 0 2 0\n"
            "n 9 0 0 0.10000000000000001\n"
            "n 3 2 0 1.5\n"
            "a 7 3\n"
            "a 7 3\n");
}

TEST(GraphExport, Json) {
  EXPECT_EQ(Circle().text("json"),
            "{\"schema\": \"reeb.graph.v1\", \"function\": \"a \\\"b\\\"\", \"threshold\": 0.25,\n"
            "\"nodes\": [\n"
            "{\"vertex\": 7, \"value\": 0, \"position\": [0, 0, 0], \"down\": 0, \"up\": 2, "
            "\"type\": 0, \"component\": 0, \"persistence\": 1.5},\n"
            "{\"vertex\": 9, \"value\": 0.1, \"position\": [4, 4, 4], \"down\": 0, \"up\": 0, "
            "\"type\": 0, \"component\": 1, \"persistence\": 0},\n"
            "{\"vertex\": 3, \"value\": 1.5, \"position\": [0, 0, 1.5], \"down\": 2, \"up\": 0, "
            "\"type\": 3, \"component\": 0, \"persistence\": 1.5}],\n"
            "\"arcs\": [\n"
            "{\"arc\": 0, \"lo\": 7, \"hi\": 3, \"vertices\": 3, \"loop\": 1.5, \"path\": [[1, 0.5, 0, 3]]},\n"
            "{\"arc\": 1, \"lo\": 7, \"hi\": 3, \"vertices\": 0, \"loop\": 1.5, \"path\": []}]}\n");
}

TEST(GraphExport, Csv) {
  EXPECT_EQ(Circle().text("csv"),
            "node,vertex,value,x,y,z,down,up,type,component,persistence\n"
            "0,7,0,0,0,0,0,2,0,0,1.5\n"
            "1,9,0.1,4,4,4,0,0,0,1,0\n"
            "2,3,1.5,0,0,1.5,2,0,3,0,1.5\n"
            "\n"
            "arc,lo,hi,lo_node,hi_node,vertices,loop\n"
            "0,7,3,0,2,3,1.5\n"
            "1,7,3,0,2,0,1.5\n");
}

TEST(GraphExport, DotAndObjAndPly) {
  EXPECT_EQ(Circle().text("dot"),
            "graph reeb {\n  rankdir=BT;\n  ranksep=0.2;\n"
            "  node [fontsize=10, height=0.2, margin=\"0.02,0.02\"];\n"
            "  7 [label=\"0\", shape=invtriangle, tooltip=\"vertex 7\"];\n"
            "  9 [label=\"0.1\", shape=invtriangle, tooltip=\"vertex 9\"];\n"
            "  3 [label=\"1.5\", shape=triangle, tooltip=\"vertex 3\"];\n"
            "  7 -- 3 [minlen=2];\n  7 -- 3 [minlen=2];\n  7 -- 9 [minlen=1, style=invis];\n}\n");
  EXPECT_EQ(Circle().text("obj"), "v 0 0 0\nv 4 4 4\nv 0 0 1.5\nv 1 0.5 0\nl 1 4 3\nl 1 3\np 2\n");
  EXPECT_EQ(Circle().text("ply"),
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
            "element edge 3\nproperty int vertex1\nproperty int vertex2\nend_header\n"
            "0 0 0\n4 4 4\n0 0 1.5\n1 0.5 0\n0 3\n3 2\n0 2\n");
}

// Nodes of one value share a rank, unless an arc is between them.
TEST(GraphExport, DotHasARankForEachValue) {
  const SweepKey a{0, VertexId(0)}, b{0, VertexId(1)}, c{0, VertexId(2)}, d{1, VertexId(3)};
  std::ostringstream out;
  write_graph(GraphFormat::kDot, {make_graph({{a, c}, {b, c}, {c, d}}, {}), "z", 0, {}, 0}, out);
  for (const char* line : {"0 -- 2 [minlen=1];", "1 -- 2 [minlen=1];", "2 -- 3 [minlen=1];"})
    EXPECT_NE(out.str().find(line), std::string::npos) << line;
}

// dot takes minutes for a hundred components that are held at their heights.
TEST(GraphExport, DotLeavesManyComponentsApart) {
  for (const std::uint64_t components : {20u, 21u}) {
    std::vector<ArcKeys> arcs;
    for (std::uint64_t i = 0; i < components; ++i)
      arcs.push_back({{static_cast<double>(i), VertexId(i)}, {static_cast<double>(100 + i), VertexId(100 + i)}});
    std::ostringstream out;
    write_graph(GraphFormat::kDot, {make_graph(arcs, {}), "z", 0, {}, 0}, out);
    const bool held = components == 20;
    EXPECT_EQ(out.str().find("invis") != std::string::npos, held);
    EXPECT_EQ(out.str().find("3 -- 103 [minlen=1];") == std::string::npos, held) << out.str();
  }
}

TEST(GraphExport, XmlFormatsHaveTheirLines) {
  EXPECT_NE(Circle().text("graphml").find("<edge id=\"1\" source=\"7\" target=\"3\">"), std::string::npos);
  EXPECT_NE(Circle().text("graphml").find("a &quot;b&quot;"), std::string::npos);
  for (const char* format : {"vtp", "vtu"}) {
    EXPECT_NE(Circle().text(format).find("NumberOfPoints=\"4\""), std::string::npos);
    EXPECT_NE(Circle().text(format).find("0 3 2 \n0 2 \n"), std::string::npos);
    EXPECT_NE(Circle().text(format).find("\n0\n0.1\n1.5\n0.125\n</DataArray>"), std::string::npos)
        << "values: the nodes', and the middle of the bucket";
  }
  EXPECT_NE(Circle().text("vtp").find("NumberOfVerts=\"1\" NumberOfLines=\"2\""), std::string::npos);
  EXPECT_NE(Circle().text("vtu").find("\n1\n4\n6\n</DataArray>"), std::string::npos) << "offsets";
  EXPECT_NE(Circle().text("vtu").find("\n1\n4\n4\n</DataArray>"), std::string::npos) << "types";
}

// A loop is cut at a second sample of the node at its top.
TEST(GraphExport, SwcHasATreeForEachComponent) {
  EXPECT_EQ(Circle().text("swc"),
            "# the Reeb graph of a \"b\"\n# id type x y z radius parent\n"
            "1 0 0 0 0 0 -1\n2 0 1 0.5 0 0 1\n3 0 0 0 1.5 0 2\n4 0 0 0 1.5 0 1\n5 0 4 4 4 0 -1\n");
}

// A function is named by its user, or by a property of a file: any bytes may be in the name.
TEST(GraphExport, AnyNameOfAFunctionIsWritten) {
  const auto text = [](const char* format) {
    std::ostringstream out;
    write_graph(*graph_format(format), {ReebGraph{}, "a\x01\n<\\\xc3\xa9\xff", 0, {}, 0}, out);
    return out.str();
  };
  EXPECT_NE(text("graphml").find("<data key=\"function\">a\\x01\\x0a&lt;\\\xc3\xa9\\xff</data>"), std::string::npos);
  EXPECT_NE(text("json").find("\"function\": \"a\\u0001\\u000a<\\\\\xc3\xa9\\\\xff\","), std::string::npos);
  EXPECT_TRUE(text("swc").starts_with("# the Reeb graph of a\\x01\\x0a<\\\xc3\xa9\\xff\n# id"));
  for (const char* format : {"rg", "csv", "dot", "vtp", "vtu", "ply", "obj", "gltf"})
    EXPECT_EQ(text(format).find('\xff'), std::string::npos) << format << " does not name the function";
}

TEST(GraphExport, MorePointsThanAFormatNumbersAreRefused) {
  // glTF: an index of 2^32 - 1 restarts a line, so it is that of no point. PLY: the last index of an int is 2^31 - 1.
  for (const auto& [most, points] : {std::pair(kMostGltfPoints, 0xffff'ffffu), {kMostPlyPoints, 0x8000'0000u}}) {
    EXPECT_NO_THROW(require_few_points(points, most, "glTF"));
    EXPECT_THROW(require_few_points(std::uint64_t{points} + 1, most, "glTF"), Error);
  }
}

TEST(GraphExport, EmptyGraphAndUnknownFormat) {
  std::ostringstream out;
  write_graph(GraphFormat::kJson, {ReebGraph{}, "z", 0, {}, 0}, out);
  EXPECT_EQ(out.str(),
            "{\"schema\": \"reeb.graph.v1\", \"function\": \"z\", \"threshold\": 0,\n\"nodes\": [],\n\"arcs\": []}\n");
  EXPECT_FALSE(graph_format("docx").has_value());
}

}  // namespace
}  // namespace reeb::io
