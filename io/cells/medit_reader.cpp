#include "io/cells/medit_reader.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "io/cells/cell_reader.h"
#include "io/mesh/batch_reader.h"
#include "io/text/entry_limit.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

constexpr TextStyle kMeditStyle = {.comments = true};

struct MeditCells {
  std::string_view keyword;
  CellShape shape = CellShape::kPoint;
  std::uint64_t nodes = 0;
};
constexpr MeditCells kCells[] = {
    {"Edges", CellShape::kEdge, 2},
    {"Triangles", CellShape::kTriangle, 3},
    {"Quadrilaterals", CellShape::kQuadrilateral, 4},
    {"Tetrahedra", CellShape::kTetrahedron, 4},
    {"Hexahedra", CellShape::kHexahedron, 8},
    {"Prisms", CellShape::kPrism, 6},
    {"Pentahedra", CellShape::kPrism, 6},
    {"Pyramids", CellShape::kPyramid, 5},
    {"EdgesP2", CellShape::kEdge, 3},
    {"TrianglesP2", CellShape::kTriangle, 6},
    {"QuadrilateralsQ2", CellShape::kQuadrilateral, 9},
    {"TetrahedraP2", CellShape::kTetrahedron, 10},
    {"HexahedraQ2", CellShape::kHexahedron, 27},
    {"PrismsP2", CellShape::kPrism, 18},
    {"PyramidsP2", CellShape::kPyramid, 14},
};

// Where the records of a section begin.
struct MeditSection {
  const MeditCells* cells = nullptr;  // null: vertices
  std::uint64_t count = 0, offset = 0, line = 1;
};

struct MeditIndex {
  MeshInfo info;
  bool has_inner_nodes = false;
  std::vector<MeditSection> sections;  // vertices first
  std::string unknown;                 // a section with a name that is not known, if there is one
  std::uint64_t unknown_count = 0;
};

// Sections that say something about vertices and cells of other sections.
constexpr std::string_view kOtherSections[] = {
    "AngleOfCornerBound",
    "BoundingBox",
    "Corners",
    "EdgeOnGeometricEdge",
    "Geometry",
    "Identifier",
    "Normals",
    "NormalAtVertices",
    "NormalAtQuadrilateralVertices",
    "NormalAtTriangleVertices",
    "RequiredEdges",
    "RequiredQuadrilaterals",
    "RequiredTriangles",
    "RequiredVertices",
    "Ridges",
    "SubDomainFromGeom",
    "SubDomainFromMesh",
    "TangentAtEdges",
    "TangentAtVertices",
    "Tangents",
    "VertexOnGeometricEdge",
    "VertexOnGeometricVertex",
};

std::uint64_t read_count(TextCursor& text) {
  if (!text.more()) {
    text.mark();
    text.fail("the file ends where a count should be", kCutOrDamagedHereHint);
  }
  const std::int64_t count = text.integer("count");
  if (count < 0) text.fail("a count is negative", kCutOrDamagedHereHint);
  return static_cast<std::uint64_t>(count);
}

void read_version(TextCursor& text, MeshInfo& info) {
  const std::uint64_t version = read_count(text);
  if (version < 1 || version > 4)
    text.fail("the file is of Medit version " + std::to_string(version) + ", which is not read",
              "versions 1 to 4 are read");
  info.float32 = version == 1;
}

MeditIndex read_medit_index(const ContentSource& content) {
  MeditIndex index;
  index.info.format = "Medit";
  index.info.vertex_count = index.info.simplex_count = 0;
  index.info.file_bytes = content.file_bytes();
  TextCursor text(content.reopen(), kMeditStyle);
  EntryLimit limit("sections of cells");
  bool vertices = false, dimension = false;
  while (text.more()) {
    const std::string keyword(text.token());
    if (keyword == "End") break;
    const auto* const cells = std::ranges::find(kCells, keyword, &MeditCells::keyword);
    if (keyword == "MeshVersionFormatted") {
      read_version(text, index.info);
    } else if (keyword == "Dimension") {
      const std::uint64_t given = read_count(text);
      if (dimension) text.fail("the file has two dimensions", kCutOrDamagedHereHint);
      if (given != 2 && given != 3) text.fail("the file is of dimension " + std::to_string(given), "2 and 3 are read");
      index.info.dimension = static_cast<unsigned>(given);
      dimension = true;
    } else if (keyword == "Vertices" || cells != std::end(kCells)) {
      MeditSection section;
      section.count = read_count(text);
      const std::uint64_t numbers = keyword == "Vertices" ? index.info.dimension : cells->nodes;
      text.require_room(section.count, numbers);
      section.offset = text.bytes().offset();
      section.line = text.line();
      if (keyword == "Vertices") {
        if (vertices) text.fail("the file has two sections of vertices", kCutOrDamagedHereHint);
        if (!dimension) text.fail("the vertices come before the dimension", kCutOrDamagedHereHint);
        vertices = true;
        *index.info.vertex_count = section.count;
        index.sections.insert(index.sections.begin(), section);
      } else {
        limit.add(1, 0, text);
        section.cells = cells;
        *index.info.simplex_count += section.count;
        index.has_inner_nodes |= cells->nodes != corner_count(cells->shape) && section.count != 0;
        index.sections.push_back(section);
      }
    } else if (std::ranges::find(kOtherSections, keyword) == std::end(kOtherSections) && index.unknown_count++ == 0) {
      index.unknown = keyword;
    }
    text.skip_to_name();
  }
  if (!vertices) {
    text.mark();
    text.fail("the file has no section of vertices", kCutOrDamagedHereHint);
  }
  return index;
}

class MeditInput final : public CellInput {
 public:
  MeditInput(std::shared_ptr<const ContentSource> content, std::shared_ptr<const MeditIndex> index)
      : content_(std::move(content)), index_(std::move(index)) {
    open_section();
  }

  const MeshInfo& info() const override { return index_->info; }
  bool has_inner_nodes() const override { return index_->has_inner_nodes; }

  Step next(CellHead& cell) override {
    if (in_cell_) skip_reference();
    while (left_ == 0) {
      if (text_->more() && !is_letter(text_->peek())) ++surplus_sections_;
      if (++section_ >= index_->sections.size()) return Step::kEnd;
      open_section();
    }
    const MeditCells* const cells = index_->sections[section_].cells;
    if (cells == nullptr) return Step::kVertices;
    --left_;
    in_cell_ = true;
    const std::uint64_t corners = corner_count(cells->shape);
    cell = {cells->shape, corners, cells->nodes - corners};
    return Step::kCell;
  }

  std::size_t read_vertices(std::span<std::vector<double>* const> columns, std::size_t limit) override {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(limit, left_));
    for (std::size_t i = 0; i < count; ++i) {
      for (auto* column : columns) {
        text_->require_more("coordinate");
        column->push_back(index_->info.float32 ? static_cast<double>(text_->finite_number<float>("coordinate"))
                                               : text_->finite_number<double>("coordinate"));
      }
      skip_reference();
    }
    left_ -= count;
    return count;
  }

  VertexId read_node() override {
    text_->require_more("vertex number");
    const std::int64_t node = text_->integer("vertex number");
    if (node < 1 || static_cast<std::uint64_t>(node) > *index_->info.vertex_count) [[unlikely]]
      text_->fail("a cell names vertex " + std::to_string(node) + ", but there are only " +
                      count_of(*index_->info.vertex_count, "vertex"),
                  "vertices are numbered from 1; the file may be damaged here");
    return VertexId(static_cast<std::uint64_t>(node) - 1);
  }

  std::uint64_t bytes_read() const override { return text_->bytes_read(); }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> lines;
    if (index_->unknown_count != 0)
      lines.push_back(count_of(index_->unknown_count, "section") + " with a name that is not known " +
                      (index_->unknown_count == 1 ? "was" : "were") + " ignored; the first is " +
                      in_quotes(index_->unknown));
    if (surplus_sections_ != 0)
      lines.push_back("records after the announced number were ignored, in " + count_of(surplus_sections_, "section"));
    return lines;
  }

 private:
  void open_section() {
    const MeditSection& section = index_->sections[section_];
    left_ = section.count;
    // Packed content moves forward only.
    if (!text_ || section.offset < text_->bytes().offset()) text_.emplace(content_->reopen(), kMeditStyle);
    text_->move_to_line(section.offset, section.line);
  }

  // The number after each record that groups them.
  void skip_reference() {
    in_cell_ = false;
    text_->require_more("reference");
    (void)text_->integer("reference");
  }

  std::shared_ptr<const ContentSource> content_;
  std::shared_ptr<const MeditIndex> index_;
  std::optional<TextCursor> text_;
  std::size_t section_ = 0;
  std::uint64_t left_ = 0, surplus_sections_ = 0;
  bool in_cell_ = false;  // its reference was not read
};

}  // namespace

bool is_medit(std::string_view head) {
  const auto skip_blanks = [&head] {
    while (!head.empty() && is_blank_or_line_end(head.front())) head.remove_prefix(1);
  };
  for (skip_blanks(); head.starts_with('#'); skip_blanks()) head.remove_prefix(std::min(head.find('\n'), head.size()));
  return head.starts_with("MeshVersionFormatted");
}

std::unique_ptr<MeshReader> open_medit(std::unique_ptr<ContentSource> content, const ReadOptions& options) {
  refuse_properties(options, "Medit", content->name());
  const std::shared_ptr<const ContentSource> shared = std::move(content);
  const auto index = std::make_shared<const MeditIndex>(read_medit_index(*shared));
  return read_cells([shared, index](const ReadOptions&) { return std::make_unique<MeditInput>(shared, index); },
                    options);
}

}  // namespace reeb::io
