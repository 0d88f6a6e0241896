// Which columns of a mesh a run needs, and how the functions find theirs among them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/port/graph_sink.h"
#include "libreeb/port/vertex_function.h"

namespace reeb::ooc {

class VertexColumns {
 public:
  // Positions are the first three coordinates, as far as the mesh has them.
  VertexColumns(std::span<VertexFunction* const> functions, unsigned dimension)
      : functions_(functions.begin(), functions.end()), position_columns_(std::min(dimension, 3u)) {
    for (unsigned k = 0; k < position_columns_; ++k) columns_.push_back(k);
    for (const VertexFunction* f : functions_)
      for (const unsigned column : f->columns())
        if (std::find(columns_.begin(), columns_.end(), column) == columns_.end()) columns_.push_back(column);
  }

  // To be gathered, in this order.
  std::span<const unsigned> columns() const { return columns_; }
  std::size_t function_count() const { return functions_.size(); }

  // From gathered columns (data[k] is columns()[k]) to positions and one array of values a function.
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> data,
                std::vector<Point>& positions, std::vector<std::vector<double>>& values) {
    positions.assign(ids.size(), Point{});
    for (unsigned k = 0; k < position_columns_; ++k)
      for (std::size_t i = 0; i < ids.size(); ++i) positions[i][k] = data[k][i];
    values.resize(functions_.size());
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      own_.clear();
      for (const unsigned column : functions_[f]->columns())
        own_.push_back(data[static_cast<std::size_t>(
            std::find(columns_.begin(), columns_.end(), column) - columns_.begin())]);
      values[f].resize(ids.size());
      functions_[f]->evaluate(ids, own_, values[f]);
    }
  }

 private:
  std::vector<VertexFunction*> functions_;
  unsigned position_columns_;
  std::vector<unsigned> columns_;
  std::vector<std::span<const double>> own_;
};

}  // namespace reeb::ooc
