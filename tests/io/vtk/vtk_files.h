// Files of VTK of every encoding, written by hand from one description.
#pragma once

#include <lz4.h>
#include <zlib.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "tests/io/formats/mesh_files.h"

namespace reeb::io::testing {

struct VtkCell {
  int type = 0;
  std::vector<std::int64_t> nodes;
};

struct VtkGrid {
  std::vector<std::array<double, 3>> points;
  std::vector<VtkCell> cells;
  std::vector<double> temperature;              // "T", one for each point
  std::vector<std::array<double, 3>> velocity;  // "velocity"
};

// --- legacy

struct LegacyStyle {
  bool binary = false;
  bool offsets = false;  // as from version 5.1 on
};

inline std::string legacy_numbers(const std::vector<double>& values, const std::string& type, bool binary) {
  std::string bytes;
  std::ostringstream text;
  for (const double value : values) {
    if (!binary)
      text << value << ' ';
    else if (type == "float")
      bytes += scalar_bytes(static_cast<float>(value), true);
    else if (type == "double")
      bytes += scalar_bytes(value, true);
    else if (type == "int")
      bytes += scalar_bytes(static_cast<std::int32_t>(value), true);
    else
      bytes += scalar_bytes(static_cast<std::int64_t>(value), true);
  }
  return (binary ? bytes : text.str()) + "\n";
}

inline std::vector<double> flat(const std::vector<std::array<double, 3>>& vectors) {
  std::vector<double> values;
  for (const auto& vector : vectors) values.insert(values.end(), vector.begin(), vector.end());
  return values;
}

inline std::string legacy_cells(const std::string& keyword, const std::vector<VtkCell>& cells, LegacyStyle style) {
  std::vector<double> counted, nodes, offsets = {0};
  for (const VtkCell& cell : cells) {
    counted.push_back(static_cast<double>(cell.nodes.size()));
    for (const std::int64_t node : cell.nodes) {
      counted.push_back(static_cast<double>(node));
      nodes.push_back(static_cast<double>(node));
    }
    offsets.push_back(static_cast<double>(nodes.size()));
  }
  std::ostringstream out;
  if (style.offsets)
    out << keyword << ' ' << offsets.size() << ' ' << nodes.size() << "\nOFFSETS vtktypeint64\n"
        << legacy_numbers(offsets, "long", style.binary) << "CONNECTIVITY vtktypeint64\n"
        << legacy_numbers(nodes, "long", style.binary);
  else
    out << keyword << ' ' << cells.size() << ' ' << counted.size() << "\n"
        << legacy_numbers(counted, "int", style.binary);
  return out.str();
}

inline std::string legacy_head(const std::string& dataset, LegacyStyle style) {
  return std::string("# vtk DataFile Version ") + (style.offsets ? "5.1" : "3.0") + "\nby hand\n" +
         (style.binary ? "BINARY" : "ASCII") + "\nDATASET " + dataset + "\n";
}

inline std::string legacy_points(const VtkGrid& grid, LegacyStyle style, const std::string& type = "double") {
  return "POINTS " + std::to_string(grid.points.size()) + " " + type + "\n" +
         legacy_numbers(flat(grid.points), type, style.binary);
}

inline std::string legacy_file(const VtkGrid& grid, LegacyStyle style) {
  std::vector<double> types;
  for (const VtkCell& cell : grid.cells) types.push_back(cell.type);
  std::string text = legacy_head("UNSTRUCTURED_GRID", style) + legacy_points(grid, style) +
                     legacy_cells("CELLS", grid.cells, style) + "CELL_TYPES " + std::to_string(types.size()) + "\n" +
                     legacy_numbers(types, "int", style.binary);
  text += "CELL_DATA " + std::to_string(types.size()) + "\nSCALARS kind int 1\nLOOKUP_TABLE default\n" +
          legacy_numbers(types, "int", style.binary);
  if (grid.temperature.empty()) return text;
  const std::string count = std::to_string(grid.points.size());
  return text + "POINT_DATA " + count + "\nSCALARS T float\nLOOKUP_TABLE default\n" +
         legacy_numbers(grid.temperature, "float", style.binary) +
         "METADATA\nINFORMATION 0\n\nFIELD more 1\nvelocity 3 " + count + " double\n" +
         legacy_numbers(flat(grid.velocity), "double", style.binary);
}

// --- XML

struct XmlStyle {
  enum class Coding { kText, kInline, kAppendedRaw, kAppendedBase64 };
  Coding coding = Coding::kText;
  std::string compressor;  // "", "ZLib", "LZ4"
  bool big_endian = false, wide_headers = false;
};

inline std::string base64(const std::string& bytes) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

inline std::string packed_block(const std::string& bytes, const std::string& compressor) {
  std::string packed(bytes.size() * 2 + 100, '\0');
  if (compressor == "LZ4") {
    packed.resize(static_cast<std::size_t>(LZ4_compress_default(
        bytes.data(), packed.data(), static_cast<int>(bytes.size()), static_cast<int>(packed.size()))));
    return packed;
  }
  uLongf size = packed.size();
  EXPECT_EQ(::compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
            Z_OK);
  packed.resize(size);
  return packed;
}

class XmlWriter {
 public:
  explicit XmlWriter(XmlStyle style) : style_(std::move(style)) {}

  std::string array(const std::string& type, const std::string& name, const std::vector<double>& values,
                    int components = 1) {
    std::string text = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                       std::to_string(components) + "\" format=\"";
    if (style_.coding == XmlStyle::Coding::kText) {
      std::ostringstream numbers;
      for (const double value : values) numbers << value << "\n";
      return text + "ascii\">\n" + numbers.str() + "</DataArray>\n";
    }
    std::string bytes;
    for (const double value : values) bytes += item(type, value);
    const auto [header, body] = framed(bytes);
    if (style_.coding == XmlStyle::Coding::kInline)
      return text + "binary\">\n   " + encoded(header, body) + "\n</DataArray>\n";
    text += "appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
    appended_ += style_.coding == XmlStyle::Coding::kAppendedRaw ? header + body : encoded(header, body);
    return text;
  }

  std::string file(const std::string& type, const std::string& pieces) const {
    std::string text = "<?xml version=\"1.0\"?>\n<!-- by <hand> -->\n<VTKFile type=\"" + type +
                       "\" version=\"1.0\" byte_order=\"" + (style_.big_endian ? "BigEndian" : "LittleEndian") + "\"" +
                       (style_.wide_headers ? " header_type=\"UInt64\"" : "") +
                       (style_.compressor.empty() ? "" : " compressor='vtk" + style_.compressor + "DataCompressor'") +
                       ">\n<" + type + ">\n" + pieces + "</" + type + ">\n";
    if (!appended_.empty())
      text += std::string("<AppendedData encoding=\"") +
              (style_.coding == XmlStyle::Coding::kAppendedRaw ? "raw" : "base64") + "\">\n _" + appended_ +
              "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
  }

 private:
  std::string item(const std::string& type, double value) const {
    const bool big = style_.big_endian;
    if (type == "Float32") return scalar_bytes(static_cast<float>(value), big);
    if (type == "Float64") return scalar_bytes(value, big);
    if (type == "Int32") return scalar_bytes(static_cast<std::int32_t>(value), big);
    if (type == "Int64") return scalar_bytes(static_cast<std::int64_t>(value), big);
    return scalar_bytes(static_cast<std::uint8_t>(value), big);
  }
  std::string header_number(std::uint64_t value) const {
    return style_.wide_headers ? scalar_bytes(value, style_.big_endian)
                               : scalar_bytes(static_cast<std::uint32_t>(value), style_.big_endian);
  }
  std::pair<std::string, std::string> framed(const std::string& bytes) const {
    if (style_.compressor.empty()) return {header_number(bytes.size()), bytes};
    constexpr std::size_t kBlock = 40;
    std::string sizes, body;
    std::size_t blocks = 0;
    for (std::size_t at = 0; at < bytes.size(); at += kBlock, ++blocks) {
      const std::string block = packed_block(bytes.substr(at, kBlock), style_.compressor);
      sizes += header_number(block.size());
      body += block;
    }
    return {header_number(blocks) + header_number(kBlock) + header_number(bytes.size() % kBlock) + sizes, body};
  }
  // VTK encodes the header of packed data on its own.
  std::string encoded(const std::string& header, const std::string& body) const {
    return style_.compressor.empty() ? base64(header + body) : base64(header) + base64(body);
  }

  XmlStyle style_;
  std::string appended_;
};

inline std::string xml_file(const VtkGrid& grid, const XmlStyle& style) {
  XmlWriter writer(style);
  std::vector<double> nodes, offsets, types;
  for (const VtkCell& cell : grid.cells) {
    for (const std::int64_t node : cell.nodes) nodes.push_back(static_cast<double>(node));
    offsets.push_back(static_cast<double>(nodes.size()));
    types.push_back(cell.type);
  }
  std::string piece = "<Piece NumberOfPoints=\"" + std::to_string(grid.points.size()) + "\" NumberOfCells=\"" +
                      std::to_string(grid.cells.size()) + "\">\n";
  if (!grid.temperature.empty())
    piece += "<PointData Scalars=\"T\">\n" + writer.array("Float32", "T", grid.temperature) +
             writer.array("Float64", "velocity", flat(grid.velocity), 3) + "</PointData>\n";
  piece += "<CellData>\n" + writer.array("Float64", "kind", types) + "</CellData>\n<Points>\n" +
           writer.array("Float64", "Points", flat(grid.points), 3) + "</Points>\n<Cells>\n" +
           writer.array("Int64", "connectivity", nodes) + writer.array("Int64", "offsets", offsets) +
           writer.array("UInt8", "types", types) + "</Cells>\n</Piece>\n";
  return writer.file("UnstructuredGrid", piece);
}

inline std::vector<XmlStyle> xml_styles() {
  using Coding = XmlStyle::Coding;
  std::vector<XmlStyle> styles = {{}};
  for (const Coding coding : {Coding::kInline, Coding::kAppendedRaw, Coding::kAppendedBase64})
    for (const char* compressor : {"", "ZLib", "LZ4"})
      for (const bool big : {false, true})
        for (const bool wide : {false, true}) styles.push_back({coding, compressor, big, wide});
  return styles;
}

}  // namespace reeb::io::testing
