// MSH, Medit and TetGen files of one small mesh, written by hand.
#pragma once

#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "tests/io/formats/mesh_files.h"

namespace reeb::io::testing {

using Point = std::array<double, 3>;

struct Element {
  int msh_type = 0;
  std::vector<std::uint64_t> nodes;  // from 0
};

inline const std::vector<Point> kPoints = {{0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, {0, 0, 1}, {0.1, 1, 1}};
inline const std::vector<Element> kElements = {
    {15, {2}}, {1, {0, 4}}, {2, {0, 1, 2}}, {4, {0, 1, 2, 3}}, {4, {1, 2, 3, 4}}};

// Tags of nodes that are neither consecutive nor ascending.
inline constexpr std::uint64_t kTags[] = {7,  8,  3,  100, 12, 13, 14, 15, 16, 17, 18,
                                          19, 20, 21, 22,  23, 24, 25, 26, 27, 28};

// Numbers of a MSH file, as text or in binary.
class MshText {
 public:
  explicit MshText(bool binary, bool big = false) : binary_(binary), big_(big) {}
  MshText& line(const std::string& text) {
    out_ += text + "\n";
    return *this;
  }
  MshText& integer(std::int64_t value) {
    out_ += binary_ ? scalar_bytes(static_cast<std::int32_t>(value), big_) : std::to_string(value) + " ";
    return *this;
  }
  MshText& size(std::uint64_t value) {
    out_ += binary_ ? scalar_bytes(value, big_) : std::to_string(value) + " ";
    return *this;
  }
  MshText& real(double value) {
    std::ostringstream text;
    text << value << ' ';
    out_ += binary_ ? scalar_bytes(value, big_) : text.str();
    return *this;
  }
  MshText& end_record() {
    if (!binary_) out_ += "\n";
    return *this;
  }
  // Sections end at the beginning of a line.
  MshText& end(const std::string& name) { return line((binary_ ? "\n$End" : "$End") + name); }
  const std::string& text() const { return out_; }
  bool binary() const { return binary_; }

 private:
  std::string out_;
  bool binary_, big_;
};

inline void add_values(MshText& out, std::size_t count) {
  out.line("$NodeData").line("1").line("\"a name\"").line("1").line("0.0").line("3").line("0").line("2");
  out.line(std::to_string(count));
  for (std::size_t i = 0; i < count; ++i)
    out.integer(static_cast<std::int64_t>(kTags[i])).real(5).real(12 + 2.0 * static_cast<double>(i)).end_record();
  out.end("NodeData");
}

inline std::string msh4(bool binary, bool big = false, const std::vector<Point>& points = kPoints,
                        const std::vector<Element>& elements = kElements) {
  MshText out(binary, big);
  out.line("$MeshFormat").line(std::string("4.1 ") + (binary ? "1" : "0") + " 8");
  if (binary) out.integer(1);
  out.end("MeshFormat").line("$Entities").size(0).size(0).size(0).size(0).end_record().end("Entities");
  out.line("$Nodes").size(2).size(points.size()).size(3).size(100).end_record();
  // The first two nodes are of a curve, with a parameter each.
  for (const auto& [begin, end, parameters] : {std::tuple(0u, std::size_t{2}, 1), {2u, points.size(), 0}}) {
    out.integer(1).integer(5).integer(parameters).size(end - begin).end_record();
    for (std::size_t i = begin; i < end; ++i) out.size(kTags[i]).end_record();
    for (std::size_t i = begin; i < end; ++i) {
      for (const double x : points[i]) out.real(x);
      for (int k = 0; k < parameters; ++k) out.real(0.25);
      out.end_record();
    }
  }
  out.end("Nodes").line("$Elements").size(elements.size()).size(elements.size()).size(1).size(9).end_record();
  for (const Element& element : elements) {
    out.integer(0).integer(1).integer(element.msh_type).size(1).end_record().size(55);
    for (const std::uint64_t node : element.nodes) out.size(kTags[node]);
    out.end_record();
  }
  out.end("Elements");
  add_values(out, points.size());
  return out.text();
}

inline std::string msh2(bool binary, bool big = false) {
  MshText out(binary, big);
  out.line("$MeshFormat").line(std::string("2.2 ") + (binary ? "1" : "0") + " 8");
  if (binary) out.integer(1);
  out.end("MeshFormat").line("$PhysicalNames").line("1").line("2 1 \"skin\"").line("$EndPhysicalNames");
  out.line("$Nodes").line(std::to_string(kPoints.size()));
  for (std::size_t i = 0; i < kPoints.size(); ++i) {
    out.integer(static_cast<std::int64_t>(kTags[i]));
    for (const double x : kPoints[i]) out.real(x);
    out.end_record();
  }
  out.end("Nodes").line("$Elements").line(std::to_string(kElements.size()));
  for (std::size_t i = 0; i < kElements.size(); ++i) {
    const Element& element = kElements[i];
    // In binary, the last two are one block.
    const bool last_two = i + 2 == kElements.size();
    if (!binary)
      out.integer(55).integer(element.msh_type).integer(2);
    else if (i + 1 != kElements.size())
      out.integer(element.msh_type).integer(last_two ? 2 : 1).integer(2).integer(55);
    else
      out.integer(55);
    out.integer(0).integer(1);
    for (const std::uint64_t node : element.nodes) out.integer(static_cast<std::int64_t>(kTags[node]));
    out.end_record();
  }
  out.end("Elements");
  add_values(out, kPoints.size());
  return out.text();
}

inline std::string medit(const std::string& version = "2") {
  return "# by hand\nMeshVersionFormatted " + version +
         "\nDimension\n3\n\nTriangles 1\n1 2 3 7\nVertices\n5\n0 0 0 1\n1 0 0.5 1\n0 1 0\n1 0 0 1 1 0.1 1 1 1\n"
         "Corners 2\n1\n2\nEdges\n1\n1 5 0\nNormals\n1\nnan 0 1\nTetrahedra\n2\n1 2 3 4 0\n2 3 4 5 0\nEnd\n";
}

inline std::string tetgen_nodes(std::uint64_t first = 0) {
  std::ostringstream out;
  out << "# vertices\n5 3 2 1\n\n";
  for (std::size_t i = 0; i < kPoints.size(); ++i)
    out << "  " << first + i << "  " << kPoints[i][0] << ' ' << kPoints[i][1] << ' ' << kPoints[i][2] << " 5 "
        << 12 + 2 * i << " 1 # marker\n";
  return out.str();
}
inline std::string tetgen_cells(std::uint64_t first = 0) {
  std::ostringstream out;
  out << "2 4 1\n";
  for (std::uint64_t i = 0; i < 2; ++i)
    out << first + i << ' ' << first + i << ' ' << first + 1 + i << ' ' << first + 2 + i << ' ' << first + 3 + i
        << " 0.5\n";
  return out.str() + "# made by hand\n";
}

}  // namespace reeb::io::testing
