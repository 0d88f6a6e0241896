// SMA and SVA.
#include "io/events/held_cell_writer.h"
#include "io/streaming/text_head.h"
#include "io/streaming/text_lines.h"
#include "io/text/number_text.h"

namespace reeb::io {
namespace {

constexpr std::size_t kMaxComment = 240;  // old readers split longer lines

class TextWriter : public HeldCellWriter {
 public:
  TextWriter(std::ostream& out, const StreamHeader& header) : HeldCellWriter(out, header, true) { write_head(); }

  void close() override {
    write_held();
    out_.flush();
  }

 private:
  void write_head() {
    std::string& text = out_.text();
    if (header_.volume) text += "# svtype tet\n";
    write_count("nverts", header_.vertex_count);
    write_count(header_.volume ? "ncells" : "nfaces", header_.cell_count);
    if (header_.volume) {
      write_width("v_pnum_f", header_.vertex_floats, 0);
      write_width("v_pnum_i", header_.vertex_ints, 0);
      write_width("c_pnum_f", header_.cell_floats, 0);
      write_width("c_pnum_i", header_.cell_ints, 0);
    }
    // Of four floats, a box of three would say that there are three.
    if (header_.box && header_.vertex_floats == 3) {
      write_corner("bb_min", header_.box->min);
      write_corner("bb_max", header_.box->max);
    }
    for (const std::string& comment : header_.comments) {
      std::string line = comment.substr(0, kMaxComment);
      for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
      LineCursor cursor(line, 0);
      text.append(is_head_keyword(cursor.word()) ? "# : " : "# ").append(line).append("\n");
    }
  }
  void write_count(const char* keyword, const std::optional<std::uint32_t>& count) {
    if (!count) return;
    out_.text().append("# ").append(keyword);
    append_field(out_.text(), *count);
    out_.text() += '\n';
  }
  void write_width(const char* keyword, unsigned width, unsigned usual) {
    if (width != usual) write_count(keyword, width);
  }
  void write_corner(const char* keyword, const std::array<float, 3>& corner) {
    out_.text().append("# ").append(keyword);
    for (const float x : corner) append_field(out_.text(), x);
    out_.text() += '\n';
  }

  void write_vertex(const StreamEvent& vertex) override {
    out_.text() += 'v';
    append_values(vertex, header_.vertex_floats, header_.vertex_ints);
    end_line();
  }

  void write_cell(const StreamEvent& cell, std::span<const std::int32_t> corners) override {
    out_.text() += header_.volume ? 'c' : 'f';
    for (const std::int32_t corner : corners) append_field(out_.text(), corner);
    append_values(cell, header_.cell_floats, header_.cell_ints);
    end_line();
  }

  void write_finalized(std::uint32_t vertex) override {
    write_held();
    out_.text() += 'x';
    append_field(out_.text(), std::int64_t{vertex} + 1);
    end_line();
  }

  void end_line() {
    out_.text() += '\n';
    out_.flush_if_full();
  }

  void append_values(const StreamEvent& event, unsigned floats, unsigned ints) {
    for (unsigned i = 0; i < floats; ++i) append_field(out_.text(), event.floats[i]);
    for (unsigned i = 0; i < ints; ++i) append_field(out_.text(), event.ints[i]);
  }
};

}  // namespace

std::unique_ptr<StreamWriter> make_text_writer(std::ostream& out, const StreamHeader& header) {
  return std::make_unique<TextWriter>(out, header);
}

}  // namespace reeb::io
