// The functions of a run on batches of vertices: the columns of the mesh that they need, how each function finds its
// own columns among those gathered, and the range of the values seen.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/base/value_range.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"

namespace reeb::ooc {

class FunctionValues {
 public:
  // Positions are the first three coordinates, as far as the mesh has them.
  FunctionValues(std::span<VertexFunction* const> functions, unsigned dimension)
      : functions_(functions.begin(), functions.end()),
        ranges_(functions.size()),
        position_columns_(std::min(dimension, 3u)) {
    for (unsigned k = 0; k < position_columns_; ++k) columns_.push_back(k);
    for (const VertexFunction* f : functions_)
      for (const unsigned column : f->columns())
        if (std::find(columns_.begin(), columns_.end(), column) == columns_.end()) columns_.push_back(column);
  }

  // The columns to gather, in this order.
  std::span<const unsigned> columns() const { return columns_; }
  std::size_t function_count() const { return functions_.size(); }
  const ValueRange& range(std::size_t function) const { return ranges_[function]; }
  const std::vector<ValueRange>& ranges() const { return ranges_; }
  // Sets the ranges as if their values had been seen. REQUIRES: one per function.
  void set_ranges(std::span<const ValueRange> ranges) { ranges_.assign(ranges.begin(), ranges.end()); }

  // Turns gathered columns (data[k] is columns()[k]) into positions and one array of values per function. Both are
  // appended.
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> data,
                std::vector<Point>& positions, std::vector<std::vector<double>>& values) {
    const std::size_t before = positions.size();
    positions.resize(before + ids.size());
    for (unsigned k = 0; k < position_columns_; ++k)
      for (std::size_t i = 0; i < ids.size(); ++i) positions[before + i][k] = data[k][i];
    values.resize(functions_.size());
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      own_.clear();
      for (const unsigned column : functions_[f]->columns())
        own_.push_back(
            data[static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin())]);
      values[f].resize(before + ids.size());
      const auto here = std::span(values[f]).subspan(before);
      functions_[f]->evaluate(ids, own_, here);
      for (const double value : here) ranges_[f].add(value);
    }
  }

  // The same for the vertices of a batch. Positions and values are replaced.
  void evaluate(const MeshBatch& batch, std::vector<Point>& positions, std::vector<std::vector<double>>& values) {
    ids_.resize(batch.vertex_count);
    for (std::size_t i = 0; i < ids_.size(); ++i) ids_[i] = VertexId(batch.first_vertex.value() + i);
    data_.clear();
    for (const unsigned column : columns_) data_.emplace_back(batch.column(column));
    positions.clear();
    for (auto& some : values) some.clear();
    evaluate(ids_, data_, positions, values);
  }

 private:
  std::vector<VertexFunction*> functions_;
  std::vector<ValueRange> ranges_;
  unsigned position_columns_;
  std::vector<unsigned> columns_;
  std::vector<std::span<const double>> own_;
  std::vector<VertexId> ids_;  // of a batch
  std::vector<std::span<const double>> data_;
};

}  // namespace reeb::ooc
