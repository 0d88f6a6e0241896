#include "io/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "io/mesh/missing_property.h"
#include "io/text/entry_limit.h"
#include "io/text/hints.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::array<const char*, 3> kCoordinateNames = {"x", "y", "z"};

constexpr std::array<TypeName, 16> kTypeNames = {{{"char", ScalarType::kInt8},
                                                  {"int8", ScalarType::kInt8},
                                                  {"uchar", ScalarType::kUint8},
                                                  {"uint8", ScalarType::kUint8},
                                                  {"short", ScalarType::kInt16},
                                                  {"int16", ScalarType::kInt16},
                                                  {"ushort", ScalarType::kUint16},
                                                  {"uint16", ScalarType::kUint16},
                                                  {"int", ScalarType::kInt32},
                                                  {"int32", ScalarType::kInt32},
                                                  {"uint", ScalarType::kUint32},
                                                  {"uint32", ScalarType::kUint32},
                                                  {"float", ScalarType::kFloat32},
                                                  {"float32", ScalarType::kFloat32},
                                                  {"double", ScalarType::kFloat64},
                                                  {"float64", ScalarType::kFloat64}}};

constexpr const char* kPlyHeaderHint = "the PLY header is damaged; write the file again";

std::optional<std::size_t> find(const std::vector<PlyProperty>& properties, std::string_view name) {
  const auto found = std::ranges::find(properties, name, &PlyProperty::name);
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

class HeaderParser {
 public:
  explicit HeaderParser(TextCursor& text) : text_(text) {}

  PlyHeader parse() {
    if (text_.token() != "ply") text_.fail("a PLY file begins with the line \"ply\"", kPlyHeaderHint);
    text_.skip_line();
    while (parse_line()) text_.skip_line();
    if (!saw_format_) text_.fail("the PLY header has no format line", kPlyHeaderHint);
    text_.skip_line();
    header_.body_offset = text_.bytes().offset();
    finish_elements();
    check_size();
    return std::move(header_);
  }

 private:
  // False at end_header.
  bool parse_line() {
    if (!text_.more()) text_.fail("the file ends in its header", kCutHint);
    const std::string keyword(text_.token());
    if (keyword == "end_header") return false;
    if (keyword == "format")
      parse_format();
    else if (keyword == "element")
      parse_element();
    else if (keyword == "property")
      parse_property();
    else if (keyword != "comment" && keyword != "obj_info")
      pass_unknown_line(keyword);
    return true;
  }

  // Some writers forget the word comment. But a line with a damaged keyword must not be lost.
  void pass_unknown_line(const std::string& keyword) {
    const std::string position = text_.position();
    const std::string second(text_.token()), third(text_.token());
    const bool whole = !second.empty() && !text_.more_on_line();
    const bool type = find_type(kTypeNames, second).has_value();
    const bool number = !third.empty() && third.find_first_not_of("0123456789") == std::string::npos;
    const bool encoding = second == "ascii" || second.starts_with("binary_");
    const bool is_text = std::ranges::none_of(
        keyword, [](char c) { return static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) == 127; });
    if (!is_text || encoding || second == "list" || (whole && !third.empty() && (type || number)) || !saw_format_)
      throw Error(ErrorKind::kBadInput, in_quotes(keyword) + " is not a PLY header line", kPlyHeaderHint)
          .at(text_.source().name(), position);
    ++header_.unknown_lines;
  }

  void parse_format() {
    const std::string_view encoding = text_.token();
    saw_format_ = true;
    if (encoding == "ascii")
      header_.encoding = PlyEncoding::kAscii;
    else if (encoding == "binary_little_endian")
      header_.encoding = PlyEncoding::kLittleEndian;
    else if (encoding == "binary_big_endian")
      header_.encoding = PlyEncoding::kBigEndian;
    else
      text_.fail("unknown PLY encoding " + in_quotes(encoding),
                 "PLY is ascii, binary_little_endian or binary_big_endian");
  }

  void parse_element() {
    PlyElement element;
    element.name = text_.token();
    if (element.name.empty()) text_.fail("an element without a name", kPlyHeaderHint);
    const std::int64_t count = text_.integer("count");
    if (count < 0) text_.fail("an element count is negative", kPlyHeaderHint);
    element_limit_.add(1, element.name.size(), text_);
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
    names_.clear();
  }

  void parse_property() {
    if (header_.elements.empty()) text_.fail("a property before the first element", kPlyHeaderHint);
    PlyProperty property;
    std::string word(text_.token());
    if (word == "list") {
      property.list_count = type_named(text_.token());
      if (is_float(*property.list_count)) text_.fail("a list length must be of an integer type", kPlyHeaderHint);
      word = text_.token();
    }
    property.type = type_named(word);
    property.name = text_.token();
    if (property.name.empty()) text_.fail("a property without a name", kPlyHeaderHint);
    property_limit_.add(1, property.name.size(), text_);
    if (!names_.insert(property.name).second)
      text_.fail("the property \"" + property.name + "\" is declared twice", kPlyHeaderHint);
    header_.elements.back().properties.push_back(std::move(property));
  }

  ScalarType type_named(std::string_view name) {
    const auto type = find_type(kTypeNames, name);
    if (!type)
      text_.fail("unknown PLY type " + in_quotes(name),
                 "the types are char uchar short ushort int uint float double, or int8 ... float64");
    return *type;
  }

  void finish_elements() {
    std::erase_if(header_.elements, [](const PlyElement& e) { return e.properties.empty(); });
    bool has_vertices = false;
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      PlyElement& element = header_.elements[i];
      if (element.name == "vertex") {
        if (std::exchange(has_vertices, true)) text_.fail("the element vertex is declared twice", kPlyHeaderHint);
        element.role = PlyRole::kVertices;
        header_.vertex_element = i;
      } else if (element.name == "face" || element.name == "tristrips") {
        element.role = element.name == "face" ? PlyRole::kFaces : PlyRole::kStrips;
        find_corners(element);
      }
    }
    if (!has_vertices) text_.fail("the PLY file has no vertex element", "check that this file is a mesh");
    count_coordinates();
  }

  void find_corners(PlyElement& element) {
    auto corners = find(element.properties, "vertex_indices");
    if (!corners) corners = find(element.properties, "vertex_index");
    if (!corners || !element.properties[*corners].list_count || is_float(element.properties[*corners].type))
      text_.fail("the element " + element.name + " has no integer list vertex_indices",
                 "write the corners of faces as the list vertex_indices or vertex_index");
    element.corners = *corners;
  }

  void count_coordinates() {
    header_.dimension = 0;
    for (const char* name : kCoordinateNames) {
      const auto found = find(header_.vertices().properties, name);
      if (!found || header_.vertices().properties[*found].list_count) break;
      ++header_.dimension;
    }
    if (header_.dimension == 0)
      text_.fail("the vertices have no coordinate x", "write them with properties x, y and z");
  }

  // The least size of a record in the body.
  std::uint64_t least_bytes(const PlyElement& element) const {
    if (header_.encoding != PlyEncoding::kAscii) return element.fixed_bytes();
    return 2 * element.properties.size();  // a digit and a separator
  }

  void check_size() const {
    const auto size = text_.source().size();
    if (!size) return;
    std::uint64_t left = *size - header_.body_offset;
    if (header_.encoding == PlyEncoding::kAscii) ++left;  // the last line end may be missing
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t each = least_bytes(element);
      if (element.count > left / each)
        throw Error(ErrorKind::kBadInput,
                    "the header announces " + count_of(element.count, element.name) + ", but the file has room for " +
                        with_commas(left / each) + " at most",
                    kCutOrHeaderHint)
            .at(text_.source().name(),
                header_.encoding == PlyEncoding::kAscii ? text_.position() : std::to_string(header_.body_offset));
      left -= element.count * each;
    }
  }

  TextCursor& text_;
  PlyHeader header_;
  std::unordered_set<std::string> names_;  // of the properties of the last element
  EntryLimit element_limit_{"elements"}, property_limit_{"properties"};
  bool saw_format_ = false;
};

}  // namespace

std::size_t PlyElement::fixed_bytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += byte_size(p.list_count.value_or(p.type));
  return bytes;
}

bool PlyElement::has_lists() const {
  return std::ranges::any_of(properties, [](const PlyProperty& p) { return p.list_count.has_value(); });
}

std::optional<PlyTriangles> PlyHeader::triangles_by_size(std::uint64_t file_bytes) const {
  std::optional<PlyTriangles> triangles;
  std::uint64_t offset = body_offset;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const PlyElement& element = elements[i];
    const auto lists =
        std::ranges::count_if(element.properties, [](const PlyProperty& p) { return p.list_count.has_value(); });
    const bool is_faces = element.role == PlyRole::kFaces && lists == 1 && !triangles;
    if (lists != 0 && !is_faces) return std::nullopt;
    std::size_t bytes = element.fixed_bytes();
    if (is_faces) {
      bytes += 3 * byte_size(element.properties[element.corners].type);
      triangles = {i, offset, bytes, element.count};
    }
    if (element.count > (file_bytes - offset) / bytes) return std::nullopt;
    offset += element.count * bytes;
  }
  return offset == file_bytes ? triangles : std::nullopt;
}

std::string PlyHeader::format() const {
  static constexpr std::array<const char*, 3> kNames = {"ASCII", "binary little endian", "binary big endian"};
  return std::string("PLY ") + kNames[static_cast<std::size_t>(encoding)];
}

std::vector<std::string> PlyHeader::property_names() const {
  std::vector<std::string> names;
  for (const PlyProperty& property : vertices().properties)
    if (!property.list_count && std::ranges::find(kCoordinateNames, property.name) == kCoordinateNames.end())
      names.push_back(property.name);
  return names;
}

std::vector<std::size_t> PlyHeader::find_properties(const std::vector<std::string>& names,
                                                    const std::string& file) const {
  const std::vector<PlyProperty>& properties = vertices().properties;
  std::unordered_map<std::string_view, std::size_t> place_of;
  for (std::size_t i = 0; i < properties.size(); ++i) place_of.emplace(properties[i].name, i);
  std::vector<std::size_t> places;
  for (const std::string& name : names) {
    const auto found = place_of.find(name);
    if (found == place_of.end() || properties[found->second].list_count)
      throw missing_property(name, property_names()).at(file);
    places.push_back(found->second);
  }
  return places;
}

std::vector<std::size_t> PlyHeader::coordinate_properties() const {
  std::vector<std::size_t> places;
  for (unsigned k = 0; k < dimension; ++k) places.push_back(*find(vertices().properties, kCoordinateNames[k]));
  return places;
}

PlyHeader read_ply_header(TextCursor& text) { return HeaderParser(text).parse(); }

}  // namespace reeb::io
