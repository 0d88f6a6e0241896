#include "io/vtk/xml_header.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "io/decoding/vtk_xml.h"
#include "io/text/entry_limit.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "io/text/xml_parser.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMostComponents = 65536;
// Of all pieces: simulations write a piece for each of thousands of processes.
constexpr std::uint64_t kMostArrays = 10 * EntryLimit::kUsual;

// Which arrays of a list of cells were found.
struct FoundArrays {
  bool nodes = false, offsets = false, types = false;
};

template <class Use>
void for_each_place(GridFile& file, const Use& use) {
  for (GridPiece& piece : file.pieces) {
    use(piece.coordinates);
    for (CellList& list : piece.cells)
      for (NumberPlace* place : {&list.nodes, &list.offsets, &list.types}) use(*place);
    for (PlacedPointArray& array : piece.arrays) use(array.place);
  }
}

// The elements of a piece that hold arrays.
bool is_section(std::string_view name) {
  static constexpr std::string_view kSections[] = {"Points", "PointData", "CellData", "Cells",
                                                   "Verts",  "Lines",     "Strips",   "Polys"};
  return std::ranges::find(kSections, name) != std::end(kSections);
}

// A file can have several time steps. An array that changes is there once for each; the first step is 0.
bool is_of_later_step(const XmlAttributes& attributes) {
  const std::string step = attribute_of(attributes, "TimeStep");
  return !step.empty() && step != "0";
}

class XmlIndexer final : private XmlParser::Handler {
 public:
  explicit XmlIndexer(const ContentSource& content) : source_(content.reopen()), xml_(*source_, *this) {}

  GridFile read() {
    while (xml_.advance()) {
    }
    if (!has_file_) xml_.fail("the file has no element VTKFile", kCutOrDamagedHint);
    if (!appended_) {
      for_each_place(file_, [&](const NumberPlace& place) {
        if (place.coding == NumberCoding::kAppended)
          xml_.fail("an array is appended, but the file has no element AppendedData", kCutOrDamagedHint);
      });
      return std::move(file_);
    }
    const std::uint64_t begin = find_appended_data(*source_, xml_, *appended_);
    for_each_place(file_, [&](NumberPlace& place) {
      if (place.coding != NumberCoding::kAppended) return;
      place.coding = appended_coding_;
      place.offset += begin;
    });
    return std::move(file_);
  }

 private:
  bool start(const std::string& name, const XmlAttributes& attributes) override {
    if (open_array_ != nullptr) {
      ++nested_;
    } else if (name == "VTKFile") {
      take_file(attributes);
    } else if (name == "AppendedData") {
      take_appended(attributes);
      return false;
    } else if (name == "Piece") {
      begin_piece(attributes);
    } else if (in_piece_ && name == "DataArray") {
      take_array(attributes);
    } else if (in_piece_ && is_section(name)) {
      section_ = name;
    }
    return true;
  }

  bool end(const std::string& name) override {
    if (name == "Piece") {
      end_piece();
    } else if (name == "DataArray") {
      open_array_ = nullptr;
    } else if (open_array_ != nullptr) {
      open_array_->offset = xml_.part_end();
      --nested_;
    } else if (is_section(name)) {
      section_.clear();
    }
    return true;
  }

  // Elements can come before the numbers of an array, and after them.
  bool text(std::string_view text) override {
    if (nested_ == 0 && !std::ranges::all_of(text, is_blank_or_line_end)) open_array_ = nullptr;
    return true;
  }

  void take_file(const XmlAttributes& attributes) {
    has_file_ = true;
    kind_ = read_vtk_xml_kind(attributes, xml_);
    unstructured_ = kind_.type == "UnstructuredGrid";
    if (!unstructured_ && kind_.type != "PolyData")
      xml_.fail("a VTK XML file of type " + kind_.type.substr(0, 40) + " is not read",
                "a mesh is of type UnstructuredGrid (.vtu) or PolyData (.vtp); convert it to one of these");
    file_.format = unstructured_ ? "VTU" : "VTP";
  }

  void take_appended(const XmlAttributes& attributes) {
    const std::string encoding = attribute_of(attributes, "encoding");
    if (!encoding.empty() && encoding != "raw" && encoding != "base64")
      refuse_attribute(xml_, "AppendedData", "encoding", encoding);
    appended_ = xml_.part_end();
    appended_coding_ = encoding == "base64" ? NumberCoding::kBase64 : NumberCoding::kRaw;
  }

  // An attribute that is a count; nothing if there is none.
  std::optional<std::uint64_t> count(const XmlAttributes& attributes, std::string_view name) const {
    const std::string text = attribute_of(attributes, name);
    if (text.empty()) return std::nullopt;
    const auto value = whole_number<std::uint64_t>(text);
    if (!value || *value >> 56 != 0)
      xml_.fail(std::string(name) + " is not a count but " + in_quotes(text), kCutOrDamagedHint);
    return value;
  }
  std::uint64_t needed_count(const XmlAttributes& attributes, const char* name) const {
    const auto value = count(attributes, name);
    if (!value) xml_.fail(std::string("an element has no attribute ") + name, kCutOrDamagedHint);
    return *value;
  }

  void begin_piece(const XmlAttributes& attributes) {
    if (in_piece_) xml_.fail("a piece begins in a piece", kCutOrDamagedHint);
    in_piece_ = true;
    section_.clear();
    has_coordinates_ = false;
    piece_limit_.add(1, 0, xml_);
    GridPiece& piece = file_.pieces.emplace_back();
    piece.points = needed_count(attributes, "NumberOfPoints");
    found_ = {};
    piece.cells.resize(unstructured_ ? 1 : found_.size());
    if (unstructured_) {
      piece.cells[0].count = needed_count(attributes, "NumberOfCells");
      return;
    }
    static constexpr std::pair<const char*, CellShape> kLists[] = {{"NumberOfVerts", CellShape::kPoints},
                                                                   {"NumberOfLines", CellShape::kPolyline},
                                                                   {"NumberOfStrips", CellShape::kStrip},
                                                                   {"NumberOfPolys", CellShape::kPolygon}};
    for (std::size_t i = 0; i < 4; ++i) {
      piece.cells[i].count = count(attributes, kLists[i].first).value_or(0);
      piece.cells[i].shape = kLists[i].second;
    }
  }

  // The number of the list to which the section's arrays belong; nothing: it holds no cells.
  std::optional<std::size_t> list_of_section() const {
    static constexpr std::string_view kSections[] = {"Verts", "Lines", "Strips", "Polys"};
    if (unstructured_) return section_ == "Cells" ? std::optional<std::size_t>(0) : std::nullopt;
    const auto* const found = std::ranges::find(kSections, section_);
    if (found == std::end(kSections)) return std::nullopt;
    return found - std::begin(kSections);
  }

  // Where the numbers of an array are; if they are appended, until read() its offset counts from the first of these
  // bytes. Nothing for an array of strings or bits.
  std::optional<NumberPlace> place_of(const XmlAttributes& attributes) const {
    const std::string type = attribute_of(attributes, "type"), format = attribute_of(attributes, "format");
    if (type == "String" || type == "Bit") return std::nullopt;
    const auto known = vtk_scalar_type(type);
    if (!known) refuse_attribute(xml_, "DataArray", "type", type);
    NumberPlace place;
    place.type = *known;
    place.big_endian = kind_.big_endian;
    place.offset = xml_.part_end();
    if (format.empty() || format == "ascii") return place;
    if (format == "appended") {
      place.coding = NumberCoding::kAppended;
      place.offset = needed_count(attributes, "offset");
    } else if (format == "binary") {
      place.coding = NumberCoding::kBase64;
    } else {
      refuse_attribute(xml_, "DataArray", "format", format);
    }
    place.has_header = true;
    place.wide_header = kind_.wide_heads;
    place.packing = kind_.packing;
    return place;
  }

  void take_array(const XmlAttributes& attributes) {
    const bool points = section_ == "Points", values = section_ == "PointData";
    const auto list = list_of_section();
    if (!points && !values && !list) return;
    if (is_of_later_step(attributes)) {
      file_.has_later_steps = true;
      return;
    }
    const auto place = place_of(attributes);
    if (!place) return;
    const std::string name = attribute_of(attributes, "Name");
    const std::uint64_t components = count(attributes, "NumberOfComponents").value_or(1);
    GridPiece& piece = file_.pieces.back();
    NumberPlace* here = nullptr;
    if (points) {
      if (components != 3) xml_.fail("points have other than three coordinates", kCutOrDamagedHint);
      here = &piece.coordinates;
      has_coordinates_ = true;
    } else if (values) {
      if (components == 0 || components > kMostComponents) return;
      piece.arrays.emplace_back();
      piece.arrays.back().name = name;
      piece.arrays.back().components = components;
      array_limit_.add(1, name.size(), xml_);
      if (file_.pieces.size() == 1) count_properties(piece.arrays.back(), property_limit_, xml_);
      here = &piece.arrays.back().place;
    } else {
      here = cell_array(name, piece.cells[*list], found_[*list]);
      if (here == nullptr) return;
      if (is_float(place->type)) xml_.fail("the array " + name + " of cells has no integers", kCutOrDamagedHint);
    }
    *here = *place;
    if (place->coding == NumberCoding::kAppended) return;
    open_array_ = here;
    nested_ = 0;
  }

  // Null if cells are not described by an array of this name.
  NumberPlace* cell_array(const std::string& name, CellList& list, FoundArrays& found) const {
    const bool nodes = name == "connectivity", offsets = name == "offsets", types = unstructured_ && name == "types";
    found.nodes |= nodes;
    found.offsets |= offsets;
    found.types |= types;
    if (nodes) return &list.nodes;
    if (offsets) return &list.offsets;
    return types ? &list.types : nullptr;
  }

  void end_piece() {
    GridPiece& piece = file_.pieces.back();
    if (piece.points != 0 && !has_coordinates_) xml_.fail("a piece has no array of points", kCutOrDamagedHint);
    for (std::size_t i = 0; i < piece.cells.size(); ++i) {
      CellList& list = piece.cells[i];
      list.layout = CellLayout::kOffsets;
      list.has_types = unstructured_;
      if (list.count != 0 && !(found_[i].nodes && found_[i].offsets && (found_[i].types || !unstructured_)))
        xml_.fail("a piece has cells, but not all arrays that describe them", kCutOrDamagedHint);
    }
    in_piece_ = false;
  }

  std::unique_ptr<ContentSource> source_;
  XmlParser xml_;
  bool has_file_ = false, unstructured_ = false;
  VtkXmlKind kind_;
  GridFile file_;
  std::optional<std::uint64_t> appended_;  // the offset after the tag
  NumberCoding appended_coding_ = NumberCoding::kRaw;
  EntryLimit piece_limit_{"pieces"}, array_limit_{"arrays", kMostArrays}, property_limit_{"properties"};
  // Of the piece that is read:
  bool in_piece_ = false, has_coordinates_ = false;
  std::string section_;                // the element around arrays
  NumberPlace* open_array_ = nullptr;  // of the array that is read, until its numbers begin
  unsigned nested_ = 0;                // elements around the parser in that array
  std::array<FoundArrays, 4> found_;   // of its lists of cells
};

}  // namespace

GridFile read_xml_header(const ContentSource& content) { return XmlIndexer(content).read(); }

}  // namespace reeb::io
