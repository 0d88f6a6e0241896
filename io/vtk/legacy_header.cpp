#include "io/vtk/legacy_header.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "io/text/text_cursor.h"
#include "io/text/text_position.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMostNumbers = std::uint64_t{1} << 56;
constexpr std::size_t kLineBytes = 4096;
constexpr const char* kDamagedHint = "the file may be cut or damaged here";

std::string upper_case(std::string_view word) {
  std::string upper(word);
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return upper;
}

// Names have blanks and other odd characters as %20.
std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const digits = text.data() + i + 1;
    const bool escape =
        text[i] == '%' && i + 2 < text.size() && std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    plain += escape ? static_cast<char>(code) : text[i];
    if (escape) i += 2;
  }
  return plain;
}

struct TypeName {
  std::string_view name;
  ScalarType type;
};
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
  explicit LegacyIndexer(const ContentSource& content) : content_(content), cursor_(content.reopen()) {}

  GridFile read() {
    if (!line().starts_with("# vtk DataFile Version")) fail("a VTK file begins with # vtk DataFile Version");
    line();  // a title
    const std::string encoding = upper_case(word());
    if (encoding != "ASCII" && encoding != "BINARY") fail("the third line of a VTK file is ASCII or BINARY");
    binary_ = encoding == "BINARY";
    for (std::string keyword; !(keyword = upper_case(word())).empty();) read_section(keyword);
    if (dataset_.empty()) fail("the file has no DATASET");
    file_.format = std::string("VTK ") + (binary_ ? "binary" : "ASCII");
    if (unstructured_) add_unstructured_cells();
    file_.pieces.push_back(std::move(piece_));
    return std::move(file_);
  }

 private:
  void read_section(const std::string& keyword) {
    if (keyword == "DATASET") return read_dataset();
    if (keyword == "METADATA") return skip_metadata();
    if (keyword == "FIELD") return read_field();
    if (dataset_.empty()) fail("\"" + keyword + "\" cannot come before DATASET");
    if (keyword == "POINTS") return read_points();
    if (keyword == "CELLS" && unstructured_) return (void)cells_.emplace(read_cells());
    if (keyword == "CELL_TYPES" && unstructured_) return read_cell_types();
    if (keyword == "POINT_DATA" || keyword == "CELL_DATA") {
      at_points_ = keyword == "POINT_DATA";
      tuples_ = number("number of tuples");
      if (at_points_ && tuples_ != piece_.points)
        fail("the values are for " + count_of(tuples_, "point") + ", but the file has " + with_commas(piece_.points));
      return;
    }
    if (!unstructured_ && read_polygons(keyword)) return;
    if (!read_attribute(keyword)) fail("\"" + keyword.substr(0, 40) + "\" does not belong here in a VTK file");
  }

  void read_dataset() {
    dataset_ = upper_case(word());
    unstructured_ = dataset_ == "UNSTRUCTURED_GRID";
    if (!unstructured_ && dataset_ != "POLYDATA")
      throw Error(ErrorKind::kBadInput, "a VTK file of " + dataset_.substr(0, 40) + " is not read",
                  "in a VTK file, a mesh is POLYDATA or UNSTRUCTURED_GRID; convert it to one of these")
          .at(content_.name(), position());
  }

  void read_points() {
    piece_.points = number("number of points");
    const auto type = scalar_type(word());
    if (!type) fail("this is no type of coordinates");
    piece_.coordinates = read_array(*type, product(piece_.points, 3));
  }

  // The lists of cells: their sizes, then all nodes; from version 5.1 on offsets and nodes.
  CellList read_cells() {
    CellList list;
    list.count = number("number of cells");
    list.node_numbers = number("size of a list of cells");
    end_line();
    if (peek_word() != "OFFSETS") {
      list.nodes = read_array_here(ScalarType::kInt32, list.node_numbers);
      return list;
    }
    word();
    list.layout = CellLayout::kOffsetsFromZero;
    const std::uint64_t offsets = list.count;
    list.count -= std::min<std::uint64_t>(list.count, 1);
    list.offsets = read_array(integer_type(), offsets);
    if (upper_case(word()) != "CONNECTIVITY") fail("after the OFFSETS of cells comes their CONNECTIVITY");
    list.nodes = read_array(integer_type(), list.node_numbers);
    return list;
  }

  void read_cell_types() {
    type_count_ = number("number of cells");
    types_ = read_array(ScalarType::kInt32, *type_count_);
  }

  void add_unstructured_cells() {
    if (!cells_) return;
    if (type_count_.value_or(0) != cells_->count)
      fail("the file has " + count_of(cells_->count, "cell") + ", but types of " +
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
      piece_.cells.push_back(read_cells());
      piece_.cells.back().shape = shape;
      return true;
    }
    return false;
  }

  // --- values

  bool read_attribute(const std::string& keyword) {
    if (keyword == "LOOKUP_TABLE") {
      word();
      const std::uint64_t colours = number("number of colours");
      read_array(binary_ ? ScalarType::kUint8 : ScalarType::kFloat32, product(colours, 4));
      return true;
    }
    const auto* const known = std::ranges::find(kAttributes, keyword, &Attribute::keyword);
    const bool scalars = keyword == "SCALARS", colours = keyword == "COLOR_SCALARS";
    if (!scalars && !colours && known == std::end(kAttributes)) return false;
    const std::string name = without_escapes(word());
    if (colours) {
      const std::uint64_t components = number("number of components");
      read_values(name, binary_ ? ScalarType::kUint8 : ScalarType::kFloat32, false, components, tuples_);
      return true;
    }
    std::uint64_t components = scalars ? 1 : known->components;
    if (components == 0) components = number("number of components");
    const std::string type = upper_case(word());
    if (scalars) {
      if (more_on_line()) components = number("number of components");
      end_line();
      if (peek_word() == "LOOKUP_TABLE") {
        word();
        word();
        end_line();
      }
    } else {
      end_line();
    }
    read_typed_values(name, type, components, tuples_);
    return true;
  }

  void read_field() {
    word();  // its name
    const std::uint64_t arrays = number("number of arrays");
    for (std::uint64_t i = 0; i < arrays; ++i) {
      std::string name(word());
      while (upper_case(name) == "METADATA") {
        skip_metadata();
        name = word();
      }
      const std::uint64_t components = number("number of components"), tuples = number("number of tuples");
      const std::string type = upper_case(word());
      end_line();
      read_typed_values(without_escapes(name), type, components, tuples);
    }
  }

  // REQUIRES: the values follow here.
  void read_typed_values(const std::string& name, const std::string& type, std::uint64_t components,
                         std::uint64_t tuples) {
    if (type == "STRING") return skip_strings(product(components, tuples));
    const bool bits = type == "BIT";
    const auto scalar = scalar_type(type);
    if (!scalar && !bits) fail("\"" + type.substr(0, 40) + "\" is no type of values");
    read_values_here(name, scalar.value_or(ScalarType::kUint8), bits, components, tuples);
  }
  void read_values(const std::string& name, ScalarType type, bool bits, std::uint64_t components,
                   std::uint64_t tuples) {
    end_line();
    read_values_here(name, type, bits, components, tuples);
  }
  void read_values_here(const std::string& name, ScalarType type, bool bits, std::uint64_t components,
                        std::uint64_t tuples) {
    const std::uint64_t numbers = product(components, tuples);
    // Bits are packed into bytes, so no function can use them.
    const bool packed = bits && binary_;
    const NumberPlace place = read_array_here(type, packed ? numbers / 8 + (numbers % 8 != 0 ? 1 : 0) : numbers);
    if (!at_points_ || packed || components == 0 || tuples != piece_.points) return;
    PlacedPointArray array;
    array.name = name;
    array.components = components;
    array.place = place;
    piece_.arrays.push_back(std::move(array));
  }

  // Of text, one a line; in binary, the length of each is before it, in a form of its own.
  void skip_strings(std::uint64_t count) {
    for (; count != 0; --count) {
      if (!cursor_.ensure(1)) fail_end();
      if (!binary_) {
        end_line();
        continue;
      }
      const auto first = static_cast<unsigned char>(*cursor_.data());
      const std::size_t bytes = std::size_t{1} << (3 - (first >> 6));
      if (!cursor_.ensure(bytes)) fail_end();
      std::uint64_t length = first & 63;
      for (std::size_t i = 1; i < bytes; ++i)
        length = (length & (kMostNumbers - 1)) << 8 | static_cast<unsigned char>(cursor_.data()[i]);
      cursor_.advance(bytes);
      skip_bytes(length);
    }
  }

  void skip_metadata() {
    end_line();
    for (std::string text = line(); !std::ranges::all_of(text, is_blank_or_line_end); text = line())
      if (!cursor_.ensure(1)) return;
  }

  // --- arrays

  NumberPlace read_array(ScalarType type, std::uint64_t count) {
    end_line();
    return read_array_here(type, count);
  }
  NumberPlace read_array_here(ScalarType type, std::uint64_t count) {
    NumberPlace place;
    place.type = type;
    place.coding = binary_ ? NumberCoding::kRaw : NumberCoding::kText;
    place.offset = cursor_.offset();
    place.big_endian = true;
    if (binary_)
      skip_bytes(product(count, byte_size(type)));
    else
      skip_words(count);
    return place;
  }

  void skip_bytes(std::uint64_t count) {
    const std::uint64_t end = cursor_.offset() + count;
    if (content_.size().value_or(end) < end)
      fail("the file announces " + count_of(count, "byte") + " here, more than it has room for");
    cursor_.move_forward(end);
    if (cursor_.offset() < end) fail_end();
  }

  void skip_words(std::uint64_t count) {
    if (const auto size = content_.size(); size && count > (*size - cursor_.offset() + 1) / 2)
      fail("the file announces " + count_of(count, "number") + " here, more than it has room for");
    bool in_word = false;
    while (true) {
      if (!cursor_.ensure(1)) {
        if (count > (in_word ? 1 : 0)) fail_end();
        return;
      }
      const char* const begin = cursor_.data();
      const char* const end = begin + cursor_.available();
      const char* next = begin;
      for (; next != end; ++next) {
        const bool separator = is_blank_or_line_end(*next);
        if (in_word && separator && --count == 0) break;
        if (count == 0) break;
        in_word = !separator;
      }
      cursor_.advance(static_cast<std::size_t>(next - begin));
      if (count == 0) return;
    }
  }

  // --- words and lines

  std::string word() {
    while (cursor_.ensure(1) && is_blank_or_line_end(*cursor_.data())) cursor_.advance(1);
    mark_ = cursor_.offset();
    return peek_text();
  }
  // The word at the cursor.
  std::string peek_text() {
    cursor_.ensure(kLineBytes);
    const std::string_view text(cursor_.data(), std::min(cursor_.available(), kLineBytes));
    const auto length = static_cast<std::size_t>(std::ranges::find_if(text, is_blank_or_line_end) - text.begin());
    if (length == kLineBytes) fail("a word of more than 4096 characters");
    std::string found(text.substr(0, length));
    cursor_.advance(length);
    return found;
  }
  // The word at the beginning of the next line, if it is a keyword, in capitals; does not move.
  std::string peek_word() {
    cursor_.ensure(32);
    const std::string_view text(cursor_.data(), std::min<std::size_t>(cursor_.available(), 32));
    return upper_case(
        text.substr(0, static_cast<std::size_t>(std::ranges::find_if(text, is_blank_or_line_end) - text.begin())));
  }
  bool more_on_line() {
    while (cursor_.ensure(1) && is_blank(*cursor_.data())) cursor_.advance(1);
    return cursor_.ensure(1) && *cursor_.data() != '\n';
  }
  std::uint64_t number(const char* what) {
    const std::string text = word();
    std::uint64_t value = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
    if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size() || value > kMostNumbers)
      fail(std::string("a ") + what + " cannot be \"" + text.substr(0, 40) + "\"");
    return value;
  }
  std::optional<ScalarType> scalar_type(const std::string& name) {
    const auto* const found = std::ranges::find(kTypeNames, upper_case(name), &TypeName::name);
    if (found == std::end(kTypeNames)) return std::nullopt;
    return found->type;
  }
  ScalarType integer_type() {
    const auto type = scalar_type(word());
    if (!type || is_float(*type)) fail("this is no type of integers");
    return *type;
  }
  std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    if (b != 0 && a > kMostNumbers / b) fail("the file announces an array of an impossible size");
    return a * b;
  }

  // The rest of a line, and past its end.
  void end_line() {
    while (cursor_.ensure(1)) {
      const void* const found = std::memchr(cursor_.data(), '\n', cursor_.available());
      cursor_.advance(found == nullptr
                          ? cursor_.available()
                          : static_cast<std::size_t>(static_cast<const char*>(found) - cursor_.data()) + 1);
      if (found != nullptr) return;
    }
  }
  // Its beginning, as far as messages and checks need it.
  std::string line() {
    mark_ = cursor_.offset();
    cursor_.ensure(kLineBytes);
    const std::string_view text(cursor_.data(), std::min(cursor_.available(), kLineBytes));
    std::string found(text.substr(0, text.find('\n')));
    end_line();
    return found;
  }

  std::string position() const { return binary_ ? std::to_string(mark_) : text_position(content_, mark_); }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kDamagedHint).at(content_.name(), position());
  }
  [[noreturn]] void fail_end() {
    mark_ = cursor_.offset() + cursor_.available();
    fail("the file ends before its last array");
  }

  const ContentSource& content_;
  Cursor cursor_;
  std::uint64_t mark_ = 0;  // the word or line that was read last
  bool binary_ = false;
  std::string dataset_;
  bool unstructured_ = false;
  bool at_points_ = false;
  std::uint64_t tuples_ = 0;
  std::optional<CellList> cells_;
  std::optional<std::uint64_t> type_count_;
  NumberPlace types_;
  GridPiece piece_;
  GridFile file_;
};

}  // namespace

GridFile read_legacy_header(const ContentSource& content) { return LegacyIndexer(content).read(); }

}  // namespace reeb::io
