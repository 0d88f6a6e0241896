// STL, ASCII (float64) and binary. Corners with equal coordinates are one vertex.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "io/formats/vertex_weld.h"
#include "io/mesh/batch_reader.h"
#include "io/mesh/simplex_assembler.h"
#include "io/text/cursor.h"
#include "io/text/text_cursor.h"

namespace reeb::io {

// Delivers each new corner as a vertex, directly before its facet.
// MEMORY: grows with the number of distinct vertices, see VertexWeld.
class StlReader : public BatchReader {
 public:
  std::uint64_t memory_bytes() const override { return weld_.memory_bytes(); }

 protected:
  StlReader(const ContentSource& source, ReadOptions options, std::string format);

  // Reads on with at most one call of add_corner() and no other event. Returns false at the end.
  virtual bool advance(MeshBatch& batch) = 0;
  // Numbers the corner, and adds it to the batch if it is new.
  void add_corner(const VertexWeld::Coordinates& point, MeshBatch& batch);

  SimplexAssembler facet_;

 private:
  void fill(MeshBatch& batch) final;

  VertexWeld weld_;
  std::optional<VertexId> pending_;  // a corner to be added to its facet, which is the next event
};

class AsciiStlReader final : public StlReader {
 public:
  AsciiStlReader(std::unique_ptr<ContentSource> source, ReadOptions options);
  std::uint64_t bytes_read() const override { return text_.bytes_read(); }

 private:
  bool advance(MeshBatch& batch) override;
  void end_loop(MeshBatch& batch);

  TextCursor text_;
  bool in_solid_ = false, in_facet_ = false, loop_ended_ = false;
  std::uint64_t loop_corners_ = 0;
};

class BinaryStlReader final : public StlReader {
 public:
  static constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

  BinaryStlReader(std::unique_ptr<ContentSource> source, ReadOptions options);
  std::uint64_t bytes_read() const override { return cursor_.bytes_read(); }
  std::vector<std::string> warnings() const override;

 private:
  bool advance(MeshBatch& batch) override;
  void require(std::size_t bytes);

  Cursor cursor_;
  std::uint64_t facets_left_ = 0;
  unsigned corner_ = 0;  // number of the corner in the facet at the cursor
  bool trailing_ = false;
};

}  // namespace reeb::io
