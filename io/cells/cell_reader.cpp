#include "io/cells/cell_reader.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "io/cells/node_selection.h"
#include "io/mesh/batch_reader.h"
#include "io/mesh/simplex_assembler.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

constexpr std::size_t kScanVertices = 4096;

NodeSelection select_nodes(CellInput& input) {
  NodeSelection nodes;
  std::vector<std::vector<double>> scratch(input.info().dimension);
  std::vector<std::vector<double>*> columns;
  for (auto& column : scratch) columns.push_back(&column);
  CellHead cell;
  for (CellInput::Step step; (step = input.next(cell)) != CellInput::Step::kEnd;) {
    if (step == CellInput::Step::kVertices) {
      nodes.add_nodes(input.read_vertices(columns, kScanVertices));
      for (auto& column : scratch) column.clear();
    } else if (step == CellInput::Step::kCell) {
      for (std::uint64_t i = 0; i < cell.corners; ++i) nodes.mark_corner(input.read_node());
      for (std::uint64_t i = 0; i < cell.inner_nodes; ++i) nodes.mark_inner(input.read_node());
    }
  }
  nodes.finish();
  return nodes;
}

FaceShape face_shape(CellShape shape) {
  switch (shape) {
    case CellShape::kPolyline:
      return FaceShape::kPolyline;
    case CellShape::kPolygon:
      return FaceShape::kPolygon;
    case CellShape::kStrip:
      return FaceShape::kStrip;
    default:
      return FaceShape::kPoints;
  }
}

class CellReader final : public BatchReader {
 public:
  CellReader(const OpenCells& open, ReadOptions options) : BatchReader(std::move(options)) {
    input_ = open(this->options());
    info_ = input_->info();
    name_all_properties();
    if (this->options().all_properties) input_ = open(this->options());
    if (!input_->has_inner_nodes()) return;
    selection_ = select_nodes(*open({}));
    info_.vertex_count = selection_->kept_count();
  }

  std::uint64_t bytes_read() const override { return input_->bytes_read(); }
  std::uint64_t memory_bytes() const override {
    return input_->memory_bytes() + (selection_ ? selection_->memory_bytes() : 0);
  }
  std::vector<std::string> warnings() const override {
    std::vector<std::string> lines = input_->warnings();
    const std::uint64_t dropped = selection_ ? selection_->node_count() - selection_->kept_count() : 0;
    if (dropped != 0)
      lines.push_back(count_of(dropped, "node") + " of higher-order cells, which " +
                      (dropped == 1 ? "is not a corner, was" : "are not corners, were") + " left out");
    return lines;
  }

 private:
  void fill(MeshBatch& batch) override {
    columns_.clear();
    for (std::size_t k = 0; k < batch.coordinates.size() + batch.properties.size(); ++k)
      columns_.push_back(&batch.column(k));
    while (room<3>(batch) != 0) {
      if (simplices_left_ != 0) {
        add_simplices(batch);
      } else if (in_cell_) {
        advance_cell(batch);
      } else {
        const CellInput::Step step = input_->next(cell_);
        if (step == CellInput::Step::kEnd) return;
        if (step == CellInput::Step::kVertices) {
          read_vertices(batch);
        } else if (step == CellInput::Step::kCell) {
          begin_cell();
        } else if (options().batch_events != 1) {
          pause();
          return;
        }
      }
    }
  }

  void read_vertices(MeshBatch& batch) {
    std::size_t count = input_->read_vertices(columns_, room<3>(batch));
    if (selection_) count = drop_nodes(count);
    count_vertices(batch, count);
  }

  // Removes the dropped ones of the last `count` vertices, and returns how many stay.
  std::size_t drop_nodes(std::size_t count) {
    std::size_t kept = 0;
    const std::size_t begin = columns_.front()->size() - count;
    for (std::size_t i = 0; i < count; ++i) {
      if (selection_->is_dropped(nodes_read_ + i)) continue;
      for (auto* column : columns_) (*column)[begin + kept] = (*column)[begin + i];
      ++kept;
    }
    for (auto* column : columns_) column->resize(begin + kept);
    nodes_read_ += count;
    return kept;
  }

  void begin_cell() {
    if (corner_count(cell_.shape) != 0) {
      read_whole_cell();
      return;
    }
    in_cell_ = true;
    face_.begin(face_shape(cell_.shape));
  }

  VertexId corner() {
    const VertexId node = input_->read_node();
    return selection_ ? VertexId(selection_->index_of(node.value())) : node;
  }

  void read_whole_cell() {
    for (std::size_t i = 0; i < cell_.corners; ++i) corners_[i] = corner();
    pass_inner_nodes();
    division_ = divide_cell(cell_.shape, std::span(corners_).first(cell_.corners));
    simplices_left_ = division_.count;
  }

  void pass_inner_nodes() {
    for (; cell_.inner_nodes != 0; --cell_.inner_nodes) (void)input_->read_node();
  }

  void add_simplices(MeshBatch& batch) {
    auto& simplices = batch.simplices[division_.dimension];
    const std::size_t each = division_.dimension + 1;
    std::size_t place = (division_.count - simplices_left_) * each;
    std::size_t count = std::min(simplices_left_, room<3>(batch));
    simplices_left_ -= count;
    for (; count != 0; --count)
      for (std::size_t i = 0; i < each; ++i) simplices.push_back(corners_[division_.corners[place++]]);
  }

  // Each corner adds at most one simplex, so that a cell need not fit into a batch.
  void advance_cell(MeshBatch& batch) {
    if (cell_.corners != 0) {
      --cell_.corners;
      face_.add(corner(), batch);
      return;
    }
    pass_inner_nodes();
    face_.end(batch);
    in_cell_ = false;
  }

  std::unique_ptr<CellInput> input_;
  std::optional<NodeSelection> selection_;
  std::uint64_t nodes_read_ = 0;
  std::vector<std::vector<double>*> columns_;
  CellHead cell_;
  std::array<VertexId, kMostCellCorners> corners_;
  CellDivision division_;
  std::size_t simplices_left_ = 0;
  SimplexAssembler face_;
  bool in_cell_ = false;
};

}  // namespace

std::unique_ptr<MeshReader> read_cells(const OpenCells& open, const ReadOptions& options) {
  return std::make_unique<CellReader>(open, options);
}

}  // namespace reeb::io
