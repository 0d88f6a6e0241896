#include "io/vtk/xml_header.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "io/vtk/vtk_xml.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::uint64_t kMostComponents = 65536;

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

class XmlIndexer {
 public:
  explicit XmlIndexer(const ContentSource& content) : content_(content), scanner_(content.reopen()) {}

  GridFile read() {
    XmlTag tag;
    while (scanner_.next(tag) && tag.name != "VTKFile") {
    }
    if (tag.name != "VTKFile") scanner_.fail(0, "the file has no element VTKFile");
    kind_ = read_vtk_xml_kind(tag, scanner_);
    unstructured_ = kind_.type == "UnstructuredGrid";
    if (!unstructured_ && kind_.type != "PolyData")
      throw Error(ErrorKind::kBadInput, "a VTK XML file of type " + kind_.type.substr(0, 40) + " is not read",
                  "a mesh is of type UnstructuredGrid (.vtu) or PolyData (.vtp); convert it to one of these")
          .at(content_.name(), std::to_string(tag.begin));
    file_.format = unstructured_ ? "VTU" : "VTP";
    bool ended = false;
    while (!ended && scanner_.next(tag)) {
      if (tag.name == "AppendedData" && !tag.closes) {
        const XmlAppendix appendix = read_xml_appendix(tag, scanner_);
        for_each_place(file_, [&](NumberPlace& place) {
          if (place.coding == NumberCoding::kAppended) append_to(appendix, place);
        });
        return std::move(file_);
      }
      ended = tag.closes && tag.name == "VTKFile";
      read_tag(tag);
    }
    if (!ended) scanner_.fail(tag.end, "the file ends before the end of its element VTKFile");
    for_each_place(file_, [&](const NumberPlace& place) {
      if (place.coding == NumberCoding::kAppended)
        scanner_.fail(tag.begin, "an array is appended, but the file has no element AppendedData");
    });
    return std::move(file_);
  }

 private:
  void read_tag(const XmlTag& tag) {
    if (tag.name == "Piece") {
      if (!tag.closes) begin_piece(tag);
      if (tag.closes || tag.is_empty) end_piece(tag);
      return;
    }
    if (!in_piece_) return;
    if (tag.name == "DataArray" && !tag.closes) return read_array(tag);
    if (!tag.is_empty && is_section(tag.name)) section_ = tag.closes ? std::string() : tag.name;
  }

  void begin_piece(const XmlTag& tag) {
    if (in_piece_) scanner_.fail(tag.begin, "a piece begins in a piece");
    in_piece_ = true;
    section_.clear();
    has_coordinates_ = false;
    GridPiece& piece = file_.pieces.emplace_back();
    piece.points = xml_count(tag, "NumberOfPoints", scanner_);
    found_.assign(unstructured_ ? 1 : 4, {});
    piece.cells.resize(found_.size());
    if (unstructured_) {
      piece.cells[0].count = xml_count(tag, "NumberOfCells", scanner_);
      return;
    }
    static constexpr std::pair<std::string_view, CellShape> kLists[] = {{"NumberOfVerts", CellShape::kPoints},
                                                                        {"NumberOfLines", CellShape::kPolyline},
                                                                        {"NumberOfStrips", CellShape::kStrip},
                                                                        {"NumberOfPolys", CellShape::kPolygon}};
    for (std::size_t i = 0; i < 4; ++i) {
      if (tag.find(kLists[i].first) != nullptr) piece.cells[i].count = xml_count(tag, kLists[i].first, scanner_);
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

  void read_array(const XmlTag& tag) {
    const bool points = section_ == "Points", values = section_ == "PointData";
    const auto list = list_of_section();
    if (!points && !values && !list) return;
    const auto place = read_xml_array(tag, kind_, scanner_);
    if (!place) return;
    const std::string name = tag.get("Name");
    const std::uint64_t components =
        tag.find("NumberOfComponents") == nullptr ? 1 : xml_count(tag, "NumberOfComponents", scanner_);
    GridPiece& piece = file_.pieces.back();
    if (points) {
      if (components != 3) scanner_.fail(tag.begin, "points have other than three coordinates");
      piece.coordinates = *place;
      has_coordinates_ = true;
    } else if (values) {
      if (components == 0 || components > kMostComponents) return;
      piece.arrays.emplace_back();
      piece.arrays.back().name = name;
      piece.arrays.back().components = components;
      piece.arrays.back().place = *place;
    } else {
      add_cell_array(tag, name, *place, piece.cells[*list], found_[*list]);
    }
  }

  void add_cell_array(const XmlTag& tag, const std::string& name, const NumberPlace& place, CellList& list,
                      FoundArrays& found) {
    const bool nodes = name == "connectivity", offsets = name == "offsets", types = unstructured_ && name == "types";
    if (!nodes && !offsets && !types) return;
    if (is_float(place.type)) scanner_.fail(tag.begin, "the array " + name + " of cells has no integers");
    if (nodes) list.nodes = place;
    if (offsets) list.offsets = place;
    if (types) list.types = place;
    found.nodes |= nodes;
    found.offsets |= offsets;
    found.types |= types;
  }

  void end_piece(const XmlTag& tag) {
    if (!in_piece_) scanner_.fail(tag.begin, "a piece ends that did not begin");
    GridPiece& piece = file_.pieces.back();
    if (piece.points != 0 && !has_coordinates_) scanner_.fail(tag.begin, "a piece has no array of points");
    for (std::size_t i = 0; i < piece.cells.size(); ++i) {
      CellList& list = piece.cells[i];
      list.layout = CellLayout::kOffsets;
      list.has_types = unstructured_;
      if (list.count != 0 && !(found_[i].nodes && found_[i].offsets && (found_[i].types || !unstructured_)))
        scanner_.fail(tag.begin, "a piece has cells, but not all arrays that describe them");
    }
    in_piece_ = false;
  }

  const ContentSource& content_;
  XmlScanner scanner_;
  VtkXmlKind kind_;
  bool unstructured_ = false;
  GridFile file_;
  // Of the piece that is read:
  bool in_piece_ = false, has_coordinates_ = false;
  std::string section_;  // the element around arrays
  std::vector<FoundArrays> found_;
};

}  // namespace

GridFile read_xml_header(const ContentSource& content) { return XmlIndexer(content).read(); }

}  // namespace reeb::io
