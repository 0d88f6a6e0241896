#include "io/cells/tetgen_reader.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "io/cells/cell_reader.h"
#include "io/cells/point_array.h"
#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/file/file_name.h"
#include "io/text/entry_limit.h"
#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr TextStyle kTetgenStyle = {.comments = true};

std::uint64_t read_count(TextCursor& text, const char* what) {
  text.require_more(what);
  const std::int64_t count = text.integer(what);
  if (count < 0) text.fail(std::string("a ") + what + " is negative", kCutOrDamagedHereHint);
  return static_cast<std::uint64_t>(count);
}

// The first line of X.node.
struct NodeHead {
  std::uint64_t nodes = 0, dimension = 0, attributes = 0;
};
NodeHead read_node_head(TextCursor& text) {
  NodeHead head;
  head.nodes = read_count(text, "number of vertices");
  head.dimension = read_count(text, "dimension");
  if (head.dimension != 2 && head.dimension != 3)
    text.fail("the vertices are of dimension " + std::to_string(head.dimension), "2 and 3 are read");
  if (text.more_on_line()) head.attributes = read_count(text, "number of attributes");
  EntryLimit("properties").add(head.attributes, 0, text);
  text.require_room(head.nodes, 1 + head.dimension + head.attributes);
  text.skip_line();
  return head;
}

// The first line of X.ele or X.face.
struct CellsHead {
  std::uint64_t cells = 0;
  CellHead each;
};
CellsHead read_cells_head(TextCursor& text, bool faces) {
  CellsHead head;
  head.cells = read_count(text, "number of cells");
  // A face has three corners, and a marker if the number after its count says so. TetGen can write six nodes, but does
  // not announce them; what follows the corners is not used.
  const std::uint64_t nodes = faces || !text.more_on_line() ? (faces ? 3 : 4) : read_count(text, "number of nodes");
  const bool triangle = nodes == 3 || nodes == 6;
  if (!triangle && nodes != 4 && nodes != 10)
    text.fail("cells of " + count_of(nodes, "node") + " are not read", "tetrahedra have 4 or 10, triangles 3 or 6");
  const std::uint64_t corners = triangle ? 3 : 4;
  head.each = {triangle ? CellShape::kTriangle : CellShape::kTetrahedron, corners, nodes - corners};
  text.require_room(head.cells, 1 + nodes);
  text.skip_line();
  return head;
}

class TetgenInput final : public CellInput {
 public:
  TetgenInput(const ContentSource& nodes, const ContentSource& cells, bool faces, const ReadOptions& options)
      : nodes_(nodes.reopen(), kTetgenStyle), cells_(cells.reopen(), kTetgenStyle) {
    node_head_ = read_node_head(nodes_);
    cells_head_ = read_cells_head(cells_, faces);
    std::vector<PointArray> arrays;
    for (std::uint64_t k = 0; k < node_head_.attributes; ++k) arrays.push_back({"attribute:" + std::to_string(k), 1});
    info_.format = "TetGen";
    info_.dimension = static_cast<unsigned>(node_head_.dimension);
    info_.property_names = property_names(arrays);
    info_.vertex_count = node_head_.nodes;
    info_.simplex_count = cells_head_.cells;
    info_.file_bytes = nodes.file_bytes() + cells.file_bytes();
    for (const std::string& property : options.properties)
      columns_.push_back(find_point_column(arrays, property, nodes.name()).array);
  }

  const MeshInfo& info() const override { return info_; }
  bool has_inner_nodes() const override { return cells_head_.each.inner_nodes != 0; }

  Step next(CellHead& cell) override {
    if (nodes_read_ != node_head_.nodes) return Step::kVertices;
    if (cells_read_ != 0) cells_.skip_line();  // attributes
    if (cells_read_ == cells_head_.cells) {
      surplus_ = surplus_ || nodes_.more() || cells_.more();
      return Step::kEnd;
    }
    ++cells_read_;
    (void)read_count(cells_, "number of a cell");
    cell = cells_head_.each;
    return Step::kCell;
  }

  std::size_t read_vertices(std::span<std::vector<double>* const> columns, std::size_t limit) override {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(limit, node_head_.nodes - nodes_read_));
    for (std::size_t i = 0; i < count; ++i, ++nodes_read_) {
      const std::uint64_t number = read_count(nodes_, "number of a vertex");
      if (nodes_read_ == 0) first_ = number;
      if (first_ > 1 || number != first_ + nodes_read_)
        nodes_.fail("vertex " + std::to_string(number) + " is out of order",
                    "vertices are numbered from 0 or 1, in their order");
      for (std::size_t k = 0; k < node_head_.dimension; ++k) columns[k]->push_back(real("coordinate"));
      attributes_.clear();
      for (std::uint64_t k = 0; k < node_head_.attributes && !columns_.empty(); ++k)
        attributes_.push_back(real("vertex property"));
      for (std::size_t k = 0; k < columns_.size(); ++k)
        columns[node_head_.dimension + k]->push_back(attributes_[columns_[k]]);
      nodes_.skip_line();
    }
    return count;
  }

  VertexId read_node() override {
    cells_.require_more("vertex number");
    const std::int64_t number = cells_.integer("vertex number"), first = static_cast<std::int64_t>(first_);
    if (number < first || static_cast<std::uint64_t>(number - first) >= node_head_.nodes) [[unlikely]]
      cells_.fail("a cell names vertex " + std::to_string(number) + ", but there are only " +
                      count_of(node_head_.nodes, "vertex"),
                  "vertices are numbered from " + std::to_string(first_) + "; the file may be damaged here");
    return VertexId(static_cast<std::uint64_t>(number - first));
  }

  std::uint64_t bytes_read() const override { return nodes_.bytes_read() + cells_.bytes_read(); }
  std::vector<std::string> warnings() const override {
    if (!surplus_) return {};
    return {"lines after the announced number of vertices or cells were ignored"};
  }

 private:
  double real(const char* what) {
    nodes_.require_more(what);
    return nodes_.finite_number<double>(what);
  }

  TextCursor nodes_, cells_;
  NodeHead node_head_;
  CellsHead cells_head_;
  MeshInfo info_;
  std::vector<std::size_t> columns_;  // attributes that are properties
  std::vector<double> attributes_;
  bool surplus_ = false;
  std::uint64_t first_ = 1, nodes_read_ = 0, cells_read_ = 0;
};

std::string stem_of(const std::string& path) {
  const std::string name = content_name(path);
  return name.substr(0, name.size() - name_suffix(name).size());
}

std::string node_path(const std::string& path, const ContentSource& cells) {
  if (path == "-")
    throw Error(ErrorKind::kBadInput, "the vertices of a TetGen mesh are in another file", "name the file X.ele")
        .at(cells.name());
  if (content_suffix(path) == ".node")
    throw Error(ErrorKind::kBadInput, "this file has only the vertices of a mesh",
                "name the file of its tetrahedra, X.ele, or of its faces, X.face")
        .at(cells.name());
  if (std::string nodes = tetgen_nodes(path); !nodes.empty()) return nodes;
  throw Error(ErrorKind::kBadInput, "there is no file " + stem_of(path) + ".node with the vertices of this mesh",
              "put it beside this file")
      .at(cells.name());
}

}  // namespace

bool is_tetgen_name(const std::string& path) {
  const std::string suffix = content_suffix(path);
  return suffix == ".ele" || suffix == ".face" || suffix == ".node";
}

std::string tetgen_nodes(const std::string& path) {
  for (const char* ending : {".node", ".node.gz", ".node.zst"})
    if (std::string nodes = stem_of(path) + ending; is_regular_file(nodes)) return nodes;
  return {};
}

std::unique_ptr<MeshReader> open_tetgen(std::unique_ptr<ContentSource> cells, const std::string& path,
                                        const ReadOptions& options) {
  const std::shared_ptr<const ContentSource> nodes = open_content(node_path(path, *cells));
  const std::shared_ptr<const ContentSource> shared = std::move(cells);
  const bool faces = content_suffix(path) == ".face";
  return read_cells(
      [nodes, shared, faces](const ReadOptions& of_vertices) {
        return std::make_unique<TetgenInput>(*nodes, *shared, faces, of_vertices);
      },
      options);
}

}  // namespace reeb::io
