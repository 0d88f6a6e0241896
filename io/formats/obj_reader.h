// Wavefront OBJ: v, f, l and p; everything else is skipped. Numbers are float64.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh/batch_reader.h"
#include "io/mesh/simplex_assembler.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

// Whether the word can begin a line of an OBJ file.
bool is_obj_keyword(std::string_view word);

class ObjReader final : public BatchReader {
 public:
  ObjReader(std::unique_ptr<ContentSource> source, ReadOptions options);

  std::uint64_t bytes_read() const override { return text_.bytes_read(); }
  std::vector<std::string> warnings() const override;

 private:
  void fill(MeshBatch& batch) override;
  bool read_plain_vertex(MeshBatch& batch);
  bool read_plain_face(MeshBatch& batch);
  void begin_line(MeshBatch& batch);
  void read_vertex(MeshBatch& batch);
  void add_vertex(const std::array<double, 3>& point, MeshBatch& batch);
  void read_corner(MeshBatch& batch);
  void finish();
  void note_skipped(std::string_view keyword);
  VertexId corner();
  void skip_texture_and_normal();
  [[noreturn]] void fail_corner(bool negative, std::uint64_t number) const;

  TextCursor text_;
  SimplexAssembler face_;
  bool in_face_ = false, has_obj_line_ = false;
  struct {
    bool normals = false, texture = false, colors = false, groups = false, materials = false;
  } skipped_;
  std::uint64_t unknown_lines_ = 0, first_unknown_line_ = 0, non_finite_extras_ = 0;
  std::uint64_t last_item_line_ = 0;  // of a vertex or a simplex that was not read at once
  bool has_open_line_ = false;        // an item is on the last line, which has no end
};

}  // namespace reeb::io
