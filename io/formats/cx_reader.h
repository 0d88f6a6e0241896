// CX: simplices of dimension 0 to 8 in space of dimension 1 to 9, as text (docs/CLI.md, Formats).
//
// One item a line: `v x1 ... xd`, with the same d everywhere, and `s i j ...`, one to nine vertices that were defined
// before, from 0. A # starts a comment. Numbers are float64.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/mesh/batch_reader.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

// Whether the name has the suffix .cx, with or without .gz or .zst after it.
bool is_cx_name(const std::string& path);

class CxReader final : public BatchReader {
 public:
  // Reads the first vertex, which tells the number of coordinates.
  CxReader(std::unique_ptr<ContentSource> source, ReadOptions options);

  std::uint64_t bytes_read() const override { return text_.bytes_read(); }
  std::vector<std::string> warnings() const override;

 private:
  void fill(MeshBatch& batch) override;
  bool read_line(MeshBatch& batch);
  void read_numbers();
  void add_vertex(MeshBatch& batch);
  void read_simplex(MeshBatch& batch);
  VertexId read_corner();

  TextCursor text_;
  std::vector<double> numbers_;  // of the vertex that was read last
  bool first_waits_ = false;     // the first vertex was read, and is in no batch yet
  std::uint64_t last_item_line_ = 0;
  bool has_open_line_ = false;  // an item is on the last line, which has no end
  std::vector<VertexId> corners_;
};

}  // namespace reeb::io
