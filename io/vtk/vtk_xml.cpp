#include "io/vtk/vtk_xml.h"

#include <algorithm>
#include <charconv>
#include <system_error>

#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

struct TypeName {
  std::string_view name;
  ScalarType type;
};
constexpr TypeName kTypeNames[] = {{"Int8", ScalarType::kInt8},       {"UInt8", ScalarType::kUint8},
                                   {"Int16", ScalarType::kInt16},     {"UInt16", ScalarType::kUint16},
                                   {"Int32", ScalarType::kInt32},     {"UInt32", ScalarType::kUint32},
                                   {"Int64", ScalarType::kInt64},     {"UInt64", ScalarType::kUint64},
                                   {"Float32", ScalarType::kFloat32}, {"Float64", ScalarType::kFloat64}};

[[noreturn]] void refuse(const XmlTag& tag, const XmlScanner& scanner, const std::string& attribute,
                         const std::string& value) {
  scanner.fail(tag.begin,
               "the element " + tag.name + " has " + attribute + "=\"" + value.substr(0, 60) + "\", which is not read");
}

}  // namespace

VtkXmlKind read_vtk_xml_kind(const XmlTag& tag, const XmlScanner& scanner) {
  VtkXmlKind kind;
  kind.type = tag.get("type");
  const std::string order = tag.get("byte_order", "LittleEndian"), header = tag.get("header_type", "UInt32");
  if (order != "LittleEndian" && order != "BigEndian") refuse(tag, scanner, "byte_order", order);
  if (header != "UInt32" && header != "UInt64") refuse(tag, scanner, "header_type", header);
  kind.big_endian = order == "BigEndian";
  kind.wide_headers = header == "UInt64";
  const std::string compressor = tag.get("compressor");
  if (compressor == "vtkZLibDataCompressor")
    kind.packing = BlockPacking::kZlib;
  else if (compressor == "vtkLZ4DataCompressor")
    kind.packing = BlockPacking::kLz4;
  else if (!compressor.empty())
    throw Error(ErrorKind::kBadInput, "the arrays are packed by " + compressor.substr(0, 60) + ", which is not read",
                "write the file with the compressor ZLib or LZ4, or without")
        .at(scanner.source().name(), std::to_string(tag.begin));
  return kind;
}

std::uint64_t xml_count(const XmlTag& tag, std::string_view attribute, const XmlScanner& scanner) {
  const std::string text = tag.get(attribute);
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size() || value >> 56 != 0)
    scanner.fail(tag.begin, "the element " + tag.name + " has no number " + std::string(attribute));
  return value;
}

std::optional<NumberPlace> read_xml_array(const XmlTag& tag, const VtkXmlKind& kind, XmlScanner& scanner) {
  NumberPlace place;
  const std::string type = tag.get("type"), format = tag.get("format", "ascii");
  if (type == "String") return std::nullopt;
  const auto* const known = std::ranges::find(kTypeNames, type, &TypeName::name);
  if (known == std::end(kTypeNames)) refuse(tag, scanner, "type", type);
  place.type = known->type;
  place.big_endian = kind.big_endian;
  if (format == "appended") {
    place.coding = NumberCoding::kAppended;
    place.offset = xml_count(tag, "offset", scanner);
  } else if (format == "binary") {
    place.coding = NumberCoding::kBase64;
    place.offset = tag.is_empty ? tag.end : scanner.text_offset();
  } else if (format == "ascii") {
    place.offset = tag.is_empty ? tag.end : scanner.text_offset();
    return place;
  } else {
    refuse(tag, scanner, "format", format);
  }
  place.has_header = true;
  place.wide_header = kind.wide_headers;
  place.packing = kind.packing;
  return place;
}

XmlAppendix read_xml_appendix(const XmlTag& tag, XmlScanner& scanner) {
  const std::string encoding = tag.get("encoding", "raw");
  if (encoding != "raw" && encoding != "base64") refuse(tag, scanner, "encoding", encoding);
  return {scanner.text_offset() + 1, encoding == "base64"};  // after an underscore
}

void append_to(const XmlAppendix& appendix, NumberPlace& place) {
  place.coding = appendix.base64 ? NumberCoding::kBase64 : NumberCoding::kRaw;
  place.offset += appendix.offset;
}

}  // namespace reeb::io
