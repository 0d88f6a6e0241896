#include "io/cells/msh_reader.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "io/cells/cell_reader.h"
#include "io/cells/msh_items.h"
#include "io/cells/point_array.h"
#include "io/cells/tag_map.h"
#include "io/text/entry_limit.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

struct MshType {
  std::int64_t number = 0;
  CellShape shape = CellShape::kPoint;
  std::uint64_t nodes = 0;
};

constexpr MshType kTypes[] = {
    {15, CellShape::kPoint, 1},
    // Lines, triangles and quadrilaterals of order 1 to 10; incomplete ones lack nodes inside.
    {1, CellShape::kEdge, 2},
    {8, CellShape::kEdge, 3},
    {26, CellShape::kEdge, 4},
    {27, CellShape::kEdge, 5},
    {28, CellShape::kEdge, 6},
    {62, CellShape::kEdge, 7},
    {63, CellShape::kEdge, 8},
    {64, CellShape::kEdge, 9},
    {65, CellShape::kEdge, 10},
    {66, CellShape::kEdge, 11},
    {2, CellShape::kTriangle, 3},
    {9, CellShape::kTriangle, 6},
    {20, CellShape::kTriangle, 9},
    {21, CellShape::kTriangle, 10},
    {22, CellShape::kTriangle, 12},
    {23, CellShape::kTriangle, 15},
    {24, CellShape::kTriangle, 15},
    {25, CellShape::kTriangle, 21},
    {3, CellShape::kQuadrilateral, 4},
    {10, CellShape::kQuadrilateral, 9},
    {16, CellShape::kQuadrilateral, 8},
    {36, CellShape::kQuadrilateral, 16},
    {37, CellShape::kQuadrilateral, 25},
    {38, CellShape::kQuadrilateral, 36},
    {39, CellShape::kQuadrilateral, 12},
    {40, CellShape::kQuadrilateral, 16},
    {41, CellShape::kQuadrilateral, 20},
    // Cells of order 1 to 5.
    {4, CellShape::kTetrahedron, 4},
    {11, CellShape::kTetrahedron, 10},
    {29, CellShape::kTetrahedron, 20},
    {30, CellShape::kTetrahedron, 35},
    {31, CellShape::kTetrahedron, 56},
    {5, CellShape::kHexahedron, 8},
    {12, CellShape::kHexahedron, 27},
    {17, CellShape::kHexahedron, 20},
    {92, CellShape::kHexahedron, 64},
    {93, CellShape::kHexahedron, 125},
    {6, CellShape::kPrism, 6},
    {13, CellShape::kPrism, 18},
    {18, CellShape::kPrism, 15},
    {90, CellShape::kPrism, 40},
    {91, CellShape::kPrism, 75},
    {7, CellShape::kPyramid, 5},
    {14, CellShape::kPyramid, 14},
    {19, CellShape::kPyramid, 13},
    {118, CellShape::kPyramid, 30},
    {119, CellShape::kPyramid, 55},
};

// Values at nodes, as their header describes them.
struct MshArray : PointArray {
  std::uint64_t offset = 0, line = 1;  // of the first value
  std::uint64_t count = 0;
};

struct MshIndex {
  MeshInfo info;
  bool has_inner_nodes = false;
  std::vector<MshArray> arrays;
};

// The values of one array at nodes, read in step with the nodes.
class MshValues {
 public:
  MshValues(const ContentSource& content, const MshArray& array) : items_(reopen_for_seeking(content)), array_(array) {
    items_.move_to(array.offset, array.line);
  }

  void read(std::uint64_t tag) {
    const bool more = read_++ < array_.count;
    if (!more || static_cast<std::uint64_t>(items_.integer("node tag")) != tag)
      items_.fail("the values of " + array_.name + " do not list node " + std::to_string(tag) + " here",
                  "write a value for every node, in the order of the nodes");
    values_.clear();
    for (std::uint64_t k = 0; k < array_.components; ++k) values_.push_back(items_.real("vertex property"));
  }
  // Of the node that was read last.
  double component(std::uint64_t k) const { return values_[static_cast<std::size_t>(k)]; }

  std::uint64_t memory_bytes() const {
    return ContentSource::kLookahead + items_.source().memory_bytes() + values_.capacity() * sizeof(double);
  }

 private:
  MshItems items_;
  MshArray array_;
  std::vector<double> values_;
  std::uint64_t read_ = 0;
};

// One component of such an array.
struct MshColumn {
  std::size_t values = 0;  // their place
  std::uint64_t component = 0;
};

class MshInput final : public CellInput {
 public:
  // `index` is null in the pass that makes it; then tags and nodes are passed over.
  MshInput(const ContentSource& content, std::shared_ptr<const MshIndex> index, const ReadOptions& options)
      : items_(content.reopen()), index_(std::move(index)) {
    if (index_ == nullptr) return;
    const std::vector<PointArray> arrays(index_->arrays.begin(), index_->arrays.end());
    std::vector<std::size_t> opened;  // the array of each of values_
    for (const std::string& property : options.properties) {
      const auto [array, component] = find_point_column(arrays, property, content.name());
      const auto place = static_cast<std::size_t>(std::ranges::find(opened, array) - opened.begin());
      if (place == opened.size()) {
        opened.push_back(array);
        values_.push_back(std::make_unique<MshValues>(content, index_->arrays[array]));
      }
      columns_.push_back({place, component});
    }
  }

  const MeshInfo& info() const override { return index_->info; }
  bool has_inner_nodes() const override { return index_->has_inner_nodes; }
  const MshFormat& format() const { return items_.format(); }
  std::vector<MshArray> take_arrays() { return std::move(arrays_); }

  Step next(CellHead& cell) override {
    while (true) {
      if (nodes_left_ != 0) return Step::kVertices;
      if (tags_left_ != 0) {
        read_tags();
        if (tags_left_ != 0) return Step::kWait;
        nodes_left_ = block_nodes_;
        continue;
      }
      if (cells_left_ != 0) {
        --cells_left_;
        cell = read_head();
        return Step::kCell;
      }
      if (blocks_left_ != 0) {
        --blocks_left_;
        if (section_ == "Nodes")
          begin_node_block();
        else
          begin_element_block();
      } else if (!section_.empty()) {
        items_.end_section(section_);
        // A file can have any number of sections of nodes, and each check looks at all tags.
        if (section_ == "Nodes" && tags_.size() >= 2 * checked_tags_) check_tags();
        section_.clear();
      } else if (!begin_section()) {
        if (tags_.size() != checked_tags_) check_tags();
        return Step::kEnd;
      }
    }
  }

  std::size_t read_vertices(std::span<std::vector<double>* const> columns, std::size_t limit) override {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(limit, nodes_left_));
    for (std::size_t i = 0; i < count; ++i) {
      if (!items_.format().version4) read_tag();
      for (std::size_t k = 0; k < 3; ++k) columns[k]->push_back(items_.real("coordinate"));
      for (std::uint64_t k = 0; k < parameters_; ++k) (void)items_.real("parameter");
      if (columns_.empty()) continue;
      const std::uint64_t tag = walk_.next(tags_);
      for (const auto& values : values_) values->read(tag);
      for (std::size_t k = 0; k < columns_.size(); ++k)
        columns[3 + k]->push_back(values_[columns_[k].values]->component(columns_[k].component));
    }
    nodes_left_ -= count;
    return count;
  }

  VertexId read_node() override {
    const std::uint64_t tag = items_.size("node tag");
    if (index_ == nullptr) return VertexId(0);
    const auto node = tags_.find(tag);
    if (!node) [[unlikely]]
      items_.fail("an element names node " + std::to_string(tag) + ", which is not among the " +
                  count_of(tags_.size(), "node") + " before it");
    return VertexId(*node);
  }

  std::uint64_t bytes_read() const override { return items_.bytes_read(); }
  std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = tags_.memory_bytes();
    for (const auto& values : values_) bytes += values->memory_bytes();
    return bytes;
  }

 private:
  // Sections of geometry and of other values are passed over.
  bool begin_section() {
    const std::string name = items_.next_section();
    if (name.empty()) return false;
    if (name == "ParametricNodes")
      items_.fail("nodes with parameters of version 2 are not read", "save the file without them, or as version 4.1");
    if (name == "NodeData") {
      read_array_head();
      items_.skip_section(name);
    } else if (name == "Nodes" || name == "Elements") {
      section_ = name;
      begin_counted_section();
    } else {
      items_.skip_section(name);
    }
    return true;
  }

  void begin_counted_section() {
    if (!items_.format().version4) {
      const std::uint64_t count = items_.format().binary ? items_.text_number("count") : items_.size("count");
      if (section_ == "Nodes")
        nodes_left_ = count;
      else if (items_.format().binary)
        elements_left_ = count;
      else
        cells_left_ = count;
      if (section_ == "Elements" && items_.format().binary && count != 0) blocks_left_ = 1;
      return;
    }
    blocks_left_ = items_.size("number of blocks");
    for (const char* what : {"count", "lowest tag", "highest tag"}) (void)items_.size(what);
  }

  // Of version 4.
  void begin_node_block() {
    const std::int64_t dimension = items_.integer("dimension");
    (void)items_.integer("entity tag");
    const std::int64_t parametric = items_.integer("parametric");
    tags_left_ = block_nodes_ = items_.size("number of nodes");
    if (dimension < 0 || dimension > 3) items_.fail("a block of nodes is of dimension " + std::to_string(dimension));
    parameters_ = parametric == 0 ? 0 : static_cast<std::uint64_t>(dimension);
  }

  // A few at a time, since they take memory.
  void read_tags() {
    constexpr std::uint64_t kAtOnce = 65536;
    const std::uint64_t count = std::min(tags_left_, kAtOnce);
    for (std::uint64_t i = 0; i < count; ++i) read_tag();
    tags_left_ -= count;
  }
  void check_tags() {
    if (tags_.has_repetition()) items_.fail("two nodes have the same tag", "give every node a tag of its own");
    checked_tags_ = tags_.size();
  }
  // The pass that makes the index keeps no tags: what it holds is not part of any account.
  void read_tag() {
    const std::uint64_t tag = items_.size("node tag");
    if (index_ != nullptr) tags_.add(tag);
  }

  // Of version 4, and of version 2 in binary.
  void begin_element_block() {
    if (items_.format().version4) {
      (void)items_.integer("dimension");
      (void)items_.integer("entity tag");
      set_type(items_.integer("element type"));
      cells_left_ = items_.size("number of elements");
      return;
    }
    set_type(items_.integer("element type"));
    cells_left_ = items_.size("number of elements");
    element_tags_ = items_.size("number of tags");
    if (cells_left_ > elements_left_ || cells_left_ == 0)
      items_.fail("the section announces fewer elements than it has");
    elements_left_ -= cells_left_;
    blocks_left_ = elements_left_ != 0 ? 1 : 0;
  }

  void set_type(std::int64_t number) {
    if (type_ != nullptr && type_->number == number) return;
    const auto* const found = std::ranges::find(kTypes, number, &MshType::number);
    if (found == std::end(kTypes))
      items_.fail("an element is of type " + std::to_string(number) + ", which is not read",
                  "points, lines, triangles, quadrilaterals, tetrahedra, hexahedra, prisms and pyramids are read");
    type_ = found;
  }

  CellHead read_head() {
    (void)items_.size("element tag");
    if (!items_.format().version4) {
      if (!items_.format().binary) {
        set_type(items_.integer("element type"));
        element_tags_ = items_.size("number of tags");
      }
      for (std::uint64_t i = 0; i < element_tags_; ++i) (void)items_.integer("tag");
    }
    const std::uint64_t corners = corner_count(type_->shape);
    return {type_->shape, corners, type_->nodes - corners};
  }

  void read_array_head() {
    MshArray array;
    for (std::uint64_t i = items_.text_number("number of names"); i != 0; --i) {
      const std::string name = items_.quoted_line();
      if (array.name.empty()) array.name = name;
    }
    for (std::uint64_t i = items_.text_number("number of real tags"); i != 0; --i) (void)items_.quoted_line();
    const std::uint64_t integers = items_.text_number("number of integer tags");
    if (integers < 3) items_.fail("values at nodes have fewer than three integer tags");
    for (std::uint64_t i = 0; i < integers; ++i) {
      const std::uint64_t tag = items_.text_number("integer tag");
      if (i == 1) array.components = tag;
      if (i == 2) array.count = tag;
    }
    array.offset = items_.here();
    array.line = items_.line();
    if (index_ != nullptr || array.components == 0 || array.components >= 65536) return;
    count_properties(array, property_limit_, items_);
    arrays_.push_back(std::move(array));
  }

  MshItems items_;
  std::shared_ptr<const MshIndex> index_;
  std::vector<std::unique_ptr<MshValues>> values_;
  std::vector<MshColumn> columns_;  // of values_, in the order of the properties
  std::vector<MshArray> arrays_;
  EntryLimit property_limit_{"properties"};
  TagMap tags_;
  std::uint64_t checked_tags_ = 0;  // the first of them are known to differ
  TagMap::Walk walk_;
  std::string section_;
  std::uint64_t blocks_left_ = 0, nodes_left_ = 0, cells_left_ = 0;
  std::uint64_t tags_left_ = 0, block_nodes_ = 0;  // of version 4: of the current block, before its nodes
  std::uint64_t elements_left_ = 0;                // of version 2 in binary: beyond the current block
  std::uint64_t parameters_ = 0, element_tags_ = 0;
  const MshType* type_ = nullptr;
};

// Reads everything once: what follows needs to know whether there are higher-order cells, and where values are.
MshIndex read_msh_index(const ContentSource& content) {
  MshIndex index;
  MshInput input(content, nullptr, {});
  const MshFormat& format = input.format();
  index.info.format = std::string("MSH ") + (format.version4 ? "4.1" : "2.2") + (format.binary ? " binary" : " ASCII");
  index.info.vertex_count = index.info.simplex_count = 0;
  index.info.file_bytes = content.file_bytes();
  std::vector<std::vector<double>> scratch(3);
  std::vector<std::vector<double>*> columns;
  for (auto& column : scratch) columns.push_back(&column);
  CellHead cell;
  for (CellInput::Step step; (step = input.next(cell)) != CellInput::Step::kEnd;) {
    if (step == CellInput::Step::kVertices) {
      *index.info.vertex_count += input.read_vertices(columns, 4096);
      for (auto& column : scratch) column.clear();
      continue;
    }
    if (step == CellInput::Step::kWait) continue;
    ++*index.info.simplex_count;
    index.has_inner_nodes |= cell.inner_nodes != 0;
    for (std::uint64_t i = 0; i < cell.corners + cell.inner_nodes; ++i) (void)input.read_node();
  }
  index.arrays = input.take_arrays();
  index.info.property_names = property_names(std::vector<PointArray>(index.arrays.begin(), index.arrays.end()));
  return index;
}

}  // namespace

std::unique_ptr<MeshReader> open_msh(std::unique_ptr<ContentSource> content, const ReadOptions& options) {
  const std::shared_ptr<const ContentSource> shared = std::move(content);
  const auto index = std::make_shared<const MshIndex>(read_msh_index(*shared));
  return read_cells(
      [shared, index](const ReadOptions& of_vertices) {
        return std::make_unique<MshInput>(*shared, index, of_vertices);
      },
      options);
}

}  // namespace reeb::io
