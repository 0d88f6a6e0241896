#include "io/decoding/vtk_xml.h"

#include <algorithm>

#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr TypeName kTypes[] = {{"Int8", ScalarType::kInt8},       {"UInt8", ScalarType::kUint8},
                               {"Int16", ScalarType::kInt16},     {"UInt16", ScalarType::kUint16},
                               {"Int32", ScalarType::kInt32},     {"UInt32", ScalarType::kUint32},
                               {"Int64", ScalarType::kInt64},     {"UInt64", ScalarType::kUint64},
                               {"Float32", ScalarType::kFloat32}, {"Float64", ScalarType::kFloat64}};

}  // namespace

std::optional<ScalarType> vtk_scalar_type(std::string_view name) { return find_type(kTypes, name); }

void refuse_attribute(const XmlParser& xml, const std::string& element, const std::string& attribute,
                      const std::string& value) {
  xml.fail("the element " + element + " has " + attribute + "=\"" + value.substr(0, 60) + "\", which is not read",
           "write the file again with ParaView or VTK");
}

VtkXmlKind read_vtk_xml_kind(const XmlAttributes& attributes, const XmlParser& xml) {
  VtkXmlKind kind;
  kind.type = attribute_of(attributes, "type");
  const std::string order = attribute_of(attributes, "byte_order"), head = attribute_of(attributes, "header_type");
  kind.big_endian = order == "BigEndian";
  if (!kind.big_endian && !order.empty() && order != "LittleEndian")
    refuse_attribute(xml, "VTKFile", "byte_order", order);
  kind.wide_heads = head == "UInt64";
  if (!kind.wide_heads && !head.empty() && head != "UInt32") refuse_attribute(xml, "VTKFile", "header_type", head);
  const std::string compressor = attribute_of(attributes, "compressor");
  if (compressor == "vtkZLibDataCompressor")
    kind.packing = BlockPacking::kZlib;
  else if (compressor == "vtkLZ4DataCompressor")
    kind.packing = BlockPacking::kLz4;
  else if (!compressor.empty())
    xml.fail("the arrays are packed by " + compressor.substr(0, 60) + ", which is not read",
             "write the file with the compressor ZLib or LZ4, or without");
  return kind;
}

// The underscore is looked for in the view that the tag ends in: a pipe has that still.
std::uint64_t find_appended_data(ContentSource& source, const XmlParser& xml, std::uint64_t tag_end) {
  for (const std::uint64_t from : {xml.view_offset(), tag_end}) {
    const std::string_view rest = source.view(from).substr(static_cast<std::size_t>(tag_end - from));
    const auto mark = std::ranges::find_if_not(rest, is_blank_or_line_end);
    if (mark == rest.end()) continue;
    if (*mark != '_') break;
    return tag_end + static_cast<std::uint64_t>(mark - rest.begin()) + 1;
  }
  throw Error(ErrorKind::kBadInput, "the appended data do not begin with an underscore", kCutOrDamagedHint)
      .at(source.name(), std::to_string(tag_end));
}

}  // namespace reeb::io
