#include "io/vtk/legacy_header.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "io/text/entry_limit.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "io/vtk/legacy_text.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

// A vtkIdType is an int in these files; a long has 64 bits, as on the machines that write them today.
constexpr TypeName kTypeNames[] = {
    {"CHAR", ScalarType::kInt8},
    {"SIGNED_CHAR", ScalarType::kInt8},
    {"UNSIGNED_CHAR", ScalarType::kUint8},
    {"SHORT", ScalarType::kInt16},
    {"UNSIGNED_SHORT", ScalarType::kUint16},
    {"INT", ScalarType::kInt32},
    {"UNSIGNED_INT", ScalarType::kUint32},
    {"LONG", ScalarType::kInt64},
    {"UNSIGNED_LONG", ScalarType::kUint64},
    {"FLOAT", ScalarType::kFloat32},
    {"DOUBLE", ScalarType::kFloat64},
    {"VTKIDTYPE", ScalarType::kInt32},
    {"VTKTYPEINT64", ScalarType::kInt64},
    {"VTKTYPEUINT64", ScalarType::kUint64},
};

// Arrays of one value kind per attribute: their numbers of components; 0: it is the first number after the name.
struct Attribute {
  std::string_view keyword;
  std::uint64_t components;
};
constexpr Attribute kAttributes[] = {
    {"VECTORS", 3},    {"NORMALS", 3},      {"TENSORS", 9},    {"TENSORS6", 6},
    {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}, {"EDGE_FLAGS", 1}, {"TEXTURE_COORDINATES", 0}};

class LegacyIndexer {
 public:
  explicit LegacyIndexer(const ContentSource& content) : text_(content) {}

  GridFile read() {
    if (!text_.line().starts_with("# vtk DataFile Version"))
      text_.fail("a VTK file begins with # vtk DataFile Version");
    text_.line();  // a title
    const std::string encoding = upper_case(text_.word());
    if (encoding != "ASCII" && encoding != "BINARY") text_.fail("the third line of a VTK file is ASCII or BINARY");
    if (encoding == "BINARY") text_.set_binary();
    for (std::string keyword; !(keyword = upper_case(text_.word())).empty();) read_section(keyword);
    if (dataset_.empty()) text_.fail("the file has no DATASET");
    file_.format = std::string("VTK ") + (text_.is_binary() ? "binary" : "ASCII");
    if (unstructured_) add_unstructured_cells();
    file_.pieces.push_back(std::move(piece_));
    return std::move(file_);
  }

 private:
  void read_section(const std::string& keyword) {
    for (const char* once : {"DATASET", "POINTS", "CELLS", "CELL_TYPES"})
      if (keyword == once && !seen_.insert(keyword).second) text_.fail("the file has " + keyword + " twice");
    if (keyword == "DATASET") return read_dataset();
    if (keyword == "METADATA") return skip_metadata();
    if (keyword == "FIELD") return read_field();
    if (dataset_.empty()) text_.fail(in_quotes(keyword) + " cannot come before DATASET");
    if (keyword == "POINTS") return read_points();
    if (keyword == "CELLS" && unstructured_) return (void)cells_.emplace(read_cells());
    if (keyword == "CELL_TYPES" && unstructured_) return read_cell_types();
    if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      at_points_ = keyword == "POINT_DATA";
      tuples_ = text_.number("number of tuples");
      if (at_points_ && tuples_ != piece_.points)
        text_.fail("the values are for " + count_of(tuples_, "point") + ", but the file has " +
                   with_commas(piece_.points));
      return;
    }
    if (!unstructured_ && read_polygons(keyword)) return;
    if (!read_attribute(keyword)) text_.fail(in_quotes(keyword) + " does not belong here in a VTK file");
  }

  void read_dataset() {
    dataset_ = upper_case(text_.word());
    unstructured_ = dataset_ == "UNSTRUCTURED_GRID";
    if (!unstructured_ && dataset_ != "POLYDATA")
      text_.fail("a VTK file of " + dataset_.substr(0, 40) + " is not read",
                 "in a VTK file, a mesh is POLYDATA or UNSTRUCTURED_GRID; convert it to one of these");
  }

  void read_points() {
    if (!piece_.arrays.empty()) text_.fail("POINT_DATA cannot come before POINTS");
    piece_.points = text_.number("number of points");
    const auto type = scalar_type(text_.word());
    if (!type) text_.fail("this is not a type of coordinates");
    piece_.coordinates = read_array(*type, text_.product(piece_.points, 3));
  }

  // The lists of cells: their sizes, then all nodes; from version 5.1 on offsets and nodes.
  CellList read_cells() {
    CellList list;
    list.count = text_.number("number of cells");
    list.node_numbers = text_.number("size of a list of cells");
    text_.end_line();
    if (text_.peek_word() != "OFFSETS") {
      list.nodes = read_array_here(ScalarType::kInt32, list.node_numbers);
      return list;
    }
    text_.word();
    list.layout = CellLayout::kOffsetsFromZero;
    const std::uint64_t offsets = list.count;
    list.count -= std::min<std::uint64_t>(list.count, 1);
    list.offsets = read_array(integer_type(), offsets);
    if (upper_case(text_.word()) != "CONNECTIVITY") text_.fail("after the OFFSETS of cells comes their CONNECTIVITY");
    list.nodes = read_array(integer_type(), list.node_numbers);
    return list;
  }

  void read_cell_types() {
    type_count_ = text_.number("number of cells");
    types_ = read_array(ScalarType::kInt32, *type_count_);
  }

  void add_unstructured_cells() {
    if (!cells_) return;
    if (type_count_.value_or(0) != cells_->count)
      text_.fail("the file has " + count_of(cells_->count, "cell") + ", but types of " +
                 with_commas(type_count_.value_or(0)));
    cells_->has_types = true;
    cells_->types = types_;
    piece_.cells.push_back(*cells_);
  }

  bool read_polygons(const std::string& keyword) {
    static constexpr std::pair<std::string_view, CellShape> kLists[] = {{"VERTICES", CellShape::kPoints},
                                                                        {"LINES", CellShape::kPolyline},
                                                                        {"POLYGONS", CellShape::kPolygon},
                                                                        {"TRIANGLE_STRIPS", CellShape::kStrip}};
    for (const auto& [name, shape] : kLists) {
      if (keyword != name) continue;
      section_limit_.add(1, 0, text_);
      piece_.cells.push_back(read_cells());
      piece_.cells.back().shape = shape;
      return true;
    }
    return false;
  }

  // --- values

  bool read_attribute(const std::string& keyword) {
    if (keyword == "LOOKUP_TABLE") {
      text_.word();
      const std::uint64_t colours = text_.number("number of colours");
      read_array(text_.is_binary() ? ScalarType::kUint8 : ScalarType::kFloat32, text_.product(colours, 4));
      return true;
    }
    const auto* const known = std::ranges::find(kAttributes, keyword, &Attribute::keyword);
    const bool scalars = keyword == "SCALARS", colours = keyword == "COLOR_SCALARS";
    if (!scalars && !colours && known == std::end(kAttributes)) return false;
    const std::string name = percent_decoded(text_.word()).text;  // blanks are written as %20
    if (colours) {
      const std::uint64_t components = text_.number("number of components");
      read_values(name, text_.is_binary() ? ScalarType::kUint8 : ScalarType::kFloat32, false, components, tuples_);
      return true;
    }
    std::uint64_t components = scalars ? 1 : known->components;
    if (components == 0) components = text_.number("number of components");
    const std::string type = upper_case(text_.word());
    if (scalars) {
      if (text_.more_on_line()) components = text_.number("number of components");
      text_.end_line();
      if (text_.peek_word() == "LOOKUP_TABLE") {
        text_.word();
        text_.word();
        text_.end_line();
      }
    } else {
      text_.end_line();
    }
    read_typed_values(name, type, components, tuples_);
    return true;
  }

  void read_field() {
    text_.word();  // its name
    const std::uint64_t arrays = text_.number("number of arrays");
    for (std::uint64_t i = 0; i < arrays; ++i) {
      std::string name(text_.word());
      while (upper_case(name) == "METADATA") {
        skip_metadata();
        name = text_.word();
      }
      const std::uint64_t components = text_.number("number of components"), tuples = text_.number("number of tuples");
      const std::string type = upper_case(text_.word());
      text_.end_line();
      read_typed_values(percent_decoded(name).text, type, components, tuples);
    }
  }

  // REQUIRES: the values follow here.
  void read_typed_values(const std::string& name, const std::string& type, std::uint64_t components,
                         std::uint64_t tuples) {
    if (type == "STRING") return text_.skip_strings(text_.product(components, tuples));
    const bool bits = type == "BIT";
    const auto scalar = scalar_type(type);
    if (!scalar && !bits) text_.fail(in_quotes(type) + " is not a type of values");
    read_values_here(name, scalar.value_or(ScalarType::kUint8), bits, components, tuples);
  }
  void read_values(const std::string& name, ScalarType type, bool bits, std::uint64_t components,
                   std::uint64_t tuples) {
    text_.end_line();
    read_values_here(name, type, bits, components, tuples);
  }
  void read_values_here(const std::string& name, ScalarType type, bool bits, std::uint64_t components,
                        std::uint64_t tuples) {
    const std::uint64_t numbers = text_.product(components, tuples);
    // Bits are packed into bytes, so no function can use them.
    const bool packed = bits && text_.is_binary();
    const NumberPlace place = read_array_here(type, packed ? numbers / 8 + (numbers % 8 != 0 ? 1 : 0) : numbers);
    if (!at_points_ || packed || components == 0 || tuples != piece_.points) return;
    PlacedPointArray array;
    array.name = name;
    array.components = components;
    array.place = place;
    count_properties(array, property_limit_, text_);
    piece_.arrays.push_back(std::move(array));
  }

  void skip_metadata() {
    text_.end_line();
    while (!std::ranges::all_of(text_.line(), is_blank_or_line_end))
      if (text_.at_end()) return;
  }

  // --- arrays

  NumberPlace read_array(ScalarType type, std::uint64_t count) {
    text_.end_line();
    return read_array_here(type, count);
  }
  NumberPlace read_array_here(ScalarType type, std::uint64_t count) {
    NumberPlace place;
    place.type = type;
    place.coding = text_.is_binary() ? NumberCoding::kRaw : NumberCoding::kText;
    place.offset = text_.offset();
    place.big_endian = true;
    if (text_.is_binary())
      text_.skip_bytes(text_.product(count, byte_size(type)));
    else
      text_.skip_words(count);
    return place;
  }

  std::optional<ScalarType> scalar_type(const std::string& name) { return find_type(kTypeNames, upper_case(name)); }
  ScalarType integer_type() {
    const auto type = scalar_type(text_.word());
    if (!type || is_float(*type)) text_.fail("this is not a type of integers");
    return *type;
  }

  LegacyText text_;
  std::string dataset_;
  bool unstructured_ = false;
  std::set<std::string> seen_;  // sections that a file has once
  bool at_points_ = false;
  std::uint64_t tuples_ = 0;
  std::optional<CellList> cells_;
  std::optional<std::uint64_t> type_count_;
  NumberPlace types_;
  GridPiece piece_;
  GridFile file_;
  EntryLimit section_limit_{"lists of cells"}, property_limit_{"properties"};
};

}  // namespace

GridFile read_legacy_header(const ContentSource& content) { return LegacyIndexer(content).read(); }

}  // namespace reeb::io
