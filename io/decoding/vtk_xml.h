// What the XML files of VTK have in common: the element VTKFile, the names of types, and where appended data begin.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io/decoding/vtk_data.h"
#include "io/file/content_source.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/xml_parser.h"

namespace reeb::io {

struct VtkXmlKind {
  std::string type;  // "UnstructuredGrid", "PolyData", "ImageData", ...
  bool big_endian = false, wide_heads = false;
  BlockPacking packing = BlockPacking::kNone;
};

// The element VTKFile, whose tag the parser has just read.
// THROWS: Error{kBadInput}: its attributes have values that are not read.
VtkXmlKind read_vtk_xml_kind(const XmlAttributes& attributes, const XmlParser& xml);

// "Int8" and so on; nothing for another name.
std::optional<ScalarType> vtk_scalar_type(std::string_view name);

// The error at a tag whose attribute has a value that is not read.
[[noreturn]] void refuse_attribute(const XmlParser& xml, const std::string& element, const std::string& attribute,
                                   const std::string& value);

// Where the bytes of the element AppendedData begin: after the first underscore. `tag_end`: the offset after the tag.
// REQUIRES: the parser has stopped there.
// THROWS: Error{kBadInput} if something else comes first.
std::uint64_t find_appended_data(ContentSource& source, const XmlParser& xml, std::uint64_t tag_end);

}  // namespace reeb::io
