// What all XML files of VTK share: the element VTKFile, and how arrays are written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/vtk/number_place.h"
#include "io/vtk/xml_scanner.h"

namespace reeb::io {

struct VtkXmlKind {
  std::string type;  // "UnstructuredGrid", "PolyData", "ImageData", ...
  bool big_endian = false, wide_headers = false;
  BlockPacking packing = BlockPacking::kNone;
};

// The element VTKFile. THROWS: Error{kBadInput}: its attributes have values that are not read.
VtkXmlKind read_vtk_xml_kind(const XmlTag& tag, const XmlScanner& scanner);

// The place of the numbers of an element DataArray; if they are appended, until append_to() its offset counts from the
// first of these bytes. Nothing for an array of strings.
// THROWS: Error{kBadInput}: an attribute is missing, or has a value that is not read.
std::optional<NumberPlace> read_xml_array(const XmlTag& tag, const VtkXmlKind& kind, XmlScanner& scanner);

// Where the bytes of an element AppendedData begin, and whether they are base64.
struct XmlAppendix {
  std::uint64_t offset = 0;
  bool base64 = false;
};
// REQUIRES: the scanner returned the tag last.
XmlAppendix read_xml_appendix(const XmlTag& tag, XmlScanner& scanner);
// Completes the place of an array that is appended.
void append_to(const XmlAppendix& appendix, NumberPlace& place);

// An attribute that is a count. THROWS: Error{kBadInput}: there is none, or it is no number below 2^56.
std::uint64_t xml_count(const XmlTag& tag, std::string_view attribute, const XmlScanner& scanner);

}  // namespace reeb::io
