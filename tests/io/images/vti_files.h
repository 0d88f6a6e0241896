// VTK XML image files written by hand, in every form.
#pragma once

#include <lz4.h>

#include "tests/io/images/image_files.h"

namespace reeb::io::testing {

inline std::string base64(const std::string& bytes) {
  static const std::string kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kAlphabet[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

inline std::string lz4_packed(const std::string& bytes) {
  std::string packed(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))), '\0');
  packed.resize(static_cast<std::size_t>(LZ4_compress_default(
      bytes.data(), packed.data(), static_cast<int>(bytes.size()), static_cast<int>(packed.size()))));
  return packed;
}

struct VtiForm {
  std::string format = "appended";  // ascii, binary, appended
  bool base64 = false;              // of appended data
  std::string packing = "";         // "", ZLib, LZ4
  bool wide_head = false, big_endian = false;
  std::size_t block_bytes = 7;
};

// An array as it is stored.
inline std::string vti_data(const std::string& bytes, const VtiForm& form) {
  const auto word = [&](std::size_t value) {
    return form.wide_head ? scalar_bytes(std::uint64_t{value}, form.big_endian)
                          : scalar_bytes(static_cast<std::uint32_t>(value), form.big_endian);
  };
  const bool text = form.base64 || form.format == "binary";
  if (form.packing.empty()) return text ? base64(word(bytes.size()) + bytes) : word(bytes.size()) + bytes;
  const std::size_t blocks = (bytes.size() + form.block_bytes - 1) / form.block_bytes;
  std::string head = word(blocks) + word(form.block_bytes) + word(bytes.size() % form.block_bytes), body;
  for (std::size_t i = 0; i < bytes.size(); i += form.block_bytes) {
    const std::string block = bytes.substr(i, form.block_bytes);
    const std::string packed = form.packing == "ZLib" ? zlib_packed(block) : lz4_packed(block);
    head += word(packed.size());
    body += packed;
  }
  return text ? base64(head) + base64(body) : head + body;
}

struct VtiArray {
  std::string name, type;
  unsigned components = 1;
  std::string bytes;  // in the byte order of the form
  std::string text;   // for ascii
};

inline std::string vti_file(const std::string& image, const std::vector<VtiArray>& arrays, const VtiForm& form = {},
                            const std::string& scalars = "") {
  std::string extent = image.substr(image.find("WholeExtent=\"") + 13);
  extent.resize(extent.find('"'));
  std::string file = "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"";
  file += form.big_endian ? "BigEndian" : "LittleEndian";
  file += form.wide_head ? "\" header_type=\"UInt64\"" : "\"";
  if (!form.packing.empty()) file.append(" compressor=\"vtk").append(form.packing).append("DataCompressor\"");
  file += ">\n<!-- a > b --><ImageData " + image +
          ">\n<FieldData><DataArray type=\"Float32\" Name=\"time\" "
          "format=\"ascii\">7</DataArray></FieldData>\n<Piece Extent=\"" +
          extent + "\">\n<PointData";
  if (!scalars.empty()) file += " Scalars=\"" + scalars + "\"";
  file += ">\n";
  std::string appended;
  for (const VtiArray& array : arrays) {
    file += "<DataArray type=\"" + array.type + "\" Name=\"" + array.name + "\" NumberOfComponents=\"" +
            std::to_string(array.components) + "\" format=\"" + form.format + "\"";
    if (form.format == "appended") {
      file += " offset=\"" + std::to_string(appended.size()) + "\"/>\n";
      appended += vti_data(array.bytes, form);
    } else {
      file += ">\n  " + (form.format == "ascii" ? array.text : vti_data(array.bytes, form)) + "\n</DataArray>\n";
    }
  }
  file += "</PointData>\n<CellData/>\n</Piece>\n</ImageData>\n";
  if (form.format == "appended")
    file += std::string("<AppendedData encoding=\"") + (form.base64 ? "base64" : "raw") + "\">\n   _" + appended +
            "\n</AppendedData>\n";
  return file + "</VTKFile>\n";
}

}  // namespace reeb::io::testing
