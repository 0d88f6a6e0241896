// Reads SMA (triangles) and SVA (tetrahedra): text, one element per line.
//
//   v X Y Z ...   a vertex            f I J K (SMA), c I J K L ... (SVA)   a cell
//   x I           a finalization      # ...                                head, or a comment
//
// Any other line is skipped with a warning, so that plain Wavefront files of "v" and "f a b c"
// are read too. Positions of faults are line:column.
#pragma once

#include "io/events/index_rules.h"
#include "io/events/stream_event.h"
#include "io/streaming/text_lines.h"
#include "io/text/cursor.h"

namespace reeb::io {

class TextEventReader : public EventReader {
 public:
  // Reads the head, up to the first line of the body. `volume`: the file is known to be SVA.
  TextEventReader(Cursor cursor, bool volume);

  std::vector<std::string> warnings() const override;
  std::uint64_t bytes_read() const override { return cursor_.bytes_read(); }
  std::uint64_t memory_bytes() const override { return EventReader::memory_bytes() + rules_.memory_bytes(); }

 private:
  enum class Line { kEmpty, kHash, kVertex, kCell, kFinal, kUnknown };
  // A corner of a cell, and whether the line finalizes its vertex.
  struct Corner {
    std::uint32_t vertex;
    bool final;
  };

  void fill() override;
  void read_head();
  Line classify(std::string_view line) const;
  void skip_unknown(std::string_view line);
  void read_vertex(std::string_view line);
  void read_cell(std::string_view line);
  Corner read_corner(LineCursor& cursor, std::size_t corner, const std::array<Corner, 4>& earlier);
  void read_finalization(std::string_view line);
  void finish();
  void require(NumberVerdict verdict, const char* what, const LineCursor& cursor) const;
  std::string place(const LineCursor& cursor) const;
  const char* cell_name() const { return header_.volume ? "tetrahedra" : "triangles"; }

  Cursor cursor_;
  LineScanner lines_;
  IndexRules rules_;
  bool has_body_ = false, done_ = false;
  std::uint64_t cells_ = 0, skipped_ = 0;
  bool surplus_ = false;  // a line had more numbers than its element
};

}  // namespace reeb::io
