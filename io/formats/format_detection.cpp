#include "io/formats/format_detection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "io/cells/medit_reader.h"
#include "io/cells/tetgen_reader.h"
#include "io/file/file_name.h"
#include "io/formats/cx_reader.h"
#include "io/formats/foreign_format.h"
#include "io/formats/obj_reader.h"
#include "io/formats/off_reader.h"
#include "io/formats/stl_reader.h"
#include "io/images/image_format.h"
#include "io/mesh/scalar_bytes.h"
#include "io/streaming/open_stream.h"
#include "io/streaming/text_head.h"

namespace reeb::io {
namespace {

std::string_view first_word(std::string_view text) {
  const auto begin = std::ranges::find_if_not(text, is_blank_or_line_end);
  return {begin, std::find_if(begin, text.end(), is_blank_or_line_end)};
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

// The text from the first line that is neither blank nor a comment.
std::string_view skip_comments(std::string_view text) {
  while (!text.empty()) {
    std::string_view rest = text;
    const std::string_view word = first_word(take_line(rest));
    if (!word.empty() && !word.starts_with('#')) return text;
    text = rest;
  }
  return text;
}

// A byte that no text has: UTF-8 and the Latin alphabets have no control characters but white space.
bool is_control(char c) { return static_cast<unsigned char>(c) < 32 && !is_blank_or_line_end(c); }

bool is_text(std::string_view head) { return std::ranges::none_of(head.substr(0, 4096), is_control); }

std::uint64_t stl_facets(std::string_view head) { return load_scalar<std::uint32_t>(head.data() + 80, false); }

bool has_binary_stl_size(std::string_view head, std::optional<std::uint64_t> size) {
  return head.size() >= BinaryStlReader::kHeaderBytes && size &&
         *size == BinaryStlReader::kHeaderBytes + stl_facets(head) * BinaryStlReader::kFacetBytes;
}

// Whether the first facet looks like one: for streams of unknown size and truncated files.
bool looks_like_binary_stl(std::string_view head) {
  constexpr std::size_t kFirstFacet = BinaryStlReader::kHeaderBytes;
  if (head.size() < kFirstFacet || stl_facets(head) == 0) return false;
  for (std::size_t place = kFirstFacet; place < kFirstFacet + 48 && place + 4 <= head.size(); place += 4) {
    const float value = std::abs(load_scalar<float>(head.data() + place, false));
    if (value != 0 && !(value > 1e-30F && value < 1e30F) && !std::isnan(value)) return false;
  }
  return true;
}

bool starts_with_solid(std::string_view head) {
  static constexpr std::string_view kSolid = "solid";
  const std::string_view word = first_word(head);
  return std::ranges::equal(word, kSolid, [](char a, char b) { return (a | 0x20) == b; });
}

// Streaming meshes announce themselves in comments before their first line.
bool has_streaming_comment(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::string_view word = first_word(line);
    if (word.empty()) continue;
    if (!word.starts_with('#')) return false;
    if (is_head_keyword(first_word(line.substr(line.find('#') + 1)))) return true;
  }
  return false;
}

bool is_vertex_number(std::string_view word) {
  return !word.empty() && word.front() != '0' && std::ranges::all_of(word, [](char c) { return c >= '0' && c <= '9'; });
}

// Whether a line is a keyword and `count` numbers of vertices, from 1.
bool is_line_of_vertices(std::string_view line, std::size_t count) {
  std::size_t words = 0;
  for (std::string_view word = first_word(line); !word.empty(); word = first_word(line), ++words) {
    if (words > 0 && !is_vertex_number(word)) return false;
    line.remove_prefix(static_cast<std::size_t>(word.end() - line.begin()));
  }
  return words == count + 1;
}

bool is_corner_number(std::string_view word) {
  if (word.starts_with('-')) word.remove_prefix(1);
  return is_vertex_number(word);
}

// Whether a line is a tetrahedron, with or without values after its corners.
bool is_cell_line(std::string_view line) {
  std::size_t words = 0;
  for (std::string_view word = first_word(line); !word.empty() && words < 5; word = first_word(line), ++words) {
    if (words == 0 ? word != "c" : !is_corner_number(word)) return false;
    line.remove_prefix(static_cast<std::size_t>(word.end() - line.begin()));
  }
  return words == 5;
}

// A streaming mesh can also come without comments. Three things occur in no OBJ file: a triangle before all vertices
// (post-order), a tetrahedron, and a line that finalizes a vertex.
bool has_streaming_line(std::string_view text) {
  bool vertices = false;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::string_view word = first_word(line);
    if (word == "x" && is_line_of_vertices(line, 1)) return true;
    if (word == "c" && is_cell_line(line)) return true;
    if (word == "f" && !vertices) return is_line_of_vertices(line, 3);
    vertices |= word == "v";
  }
  return false;
}

// The second byte of SMB and SVB is a byte order, that of SMC version 1 is 1. Older and other kinds are told by name.
bool starts_like_stream(std::string_view head) {
  if (head.empty() || !looks_like_binary_stream(head.front())) return false;
  if (head.size() == 1 || head[0] == 3) return true;
  return head[0] == 1 ? head[1] == 1 : head[0] != 2 && (head[1] == 0 || head[1] == 1);
}

// A binary STL title that begins with a zero byte has only zeros; the head of a streaming mesh does not.
bool is_streaming_binary(std::string_view head) {
  const std::string_view stl_title = head.substr(0, 80);
  return starts_like_stream(head) && std::ranges::any_of(stl_title, [](char c) { return c != 0; });
}

// Some OBJ files have stray lines before the first line that is OBJ.
bool has_obj_vertex(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    const std::string_view word = first_word(line);
    if (word != "v") continue;
    const std::string_view rest = line.substr(static_cast<std::size_t>(word.end() - line.begin()));
    if (parse_number<double>(first_word(rest)).ok) return true;
  }
  return false;
}

// Its first element says what it holds.
bool is_vtk_xml_mesh(std::string_view head) {
  if (!first_word(head).starts_with('<')) return false;
  const std::size_t begin = head.find("<VTKFile");
  if (begin == std::string_view::npos) return false;
  const std::string_view element = head.substr(begin, head.find('>', begin) - begin);
  return element.find("UnstructuredGrid") != std::string_view::npos ||
         element.find("PolyData") != std::string_view::npos;
}

MeshFormat detect_text(std::string_view text, const std::string& path) {
  if (is_tetgen_name(path)) return MeshFormat::kTetgen;
  if (is_streaming_name(path)) return MeshFormat::kStreaming;
  if (has_streaming_line(text)) return MeshFormat::kStreaming;
  const std::string_view word = first_word(skip_comments(text));
  if (is_obj_keyword(word)) return MeshFormat::kObj;
  if (has_obj_vertex(text)) return MeshFormat::kObj;
  // An OBJ file of comments has no vertices.
  return word.empty() && content_suffix(path) == ".obj" ? MeshFormat::kObj : MeshFormat::kUnknown;
}

// The complete lines of a text that has not arrived in full.
std::string_view whole_lines(std::string_view text) { return text.substr(0, text.rfind('\n') + 1); }

// Its size, 348, comes first, and its magic word in bytes 344 to 347. No streaming mesh that can be read begins so: the
// third byte would be a compression that is not known.
bool may_be_big_endian_nifti(std::string_view head) { return head.starts_with(std::string_view("\0\0\1", 3)); }

// Whether a streaming mesh announces itself in this text. Some programs write such comments into OBJ files, too.
bool announces_stream(std::string_view text, const std::string& path) {
  return has_streaming_comment(text) && content_suffix(path) != ".obj";
}

// Whether these first bytes of a pipe are enough to recognize a streaming mesh.
bool starts_streaming(std::string_view head, const std::string& path) {
  const std::string_view lines = whole_lines(head);
  return is_streaming_binary(head) || announces_stream(lines, path) || has_streaming_line(lines);
}

std::string_view without_byte_order_mark(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  return head;
}

}  // namespace

std::optional<MarkedContent> marked_content(ContentSource& source, std::size_t min_bytes) {
  const std::string_view head = without_byte_order_mark(source.view(0, min_bytes));
  const auto mesh = [](MeshFormat format) { return MarkedContent{format, format_name(format)}; };
  if (head.starts_with("ply") && (head.size() == 3 || is_blank_or_line_end(head[3]))) return mesh(MeshFormat::kPly);
  // A streaming mesh can have that size by chance.
  if (has_binary_stl_size(head, source.size()) && !is_streaming_binary(head)) return mesh(MeshFormat::kBinaryStl);
  if (const auto image = image_format_of(head)) return MarkedContent{MeshFormat::kUnknown, image_name(*image)};
  if (head.starts_with("# vtk DataFile")) return mesh(MeshFormat::kVtkLegacy);
  if (is_vtk_xml_mesh(head)) return mesh(MeshFormat::kVtkXml);
  if (head.starts_with("$MeshFormat")) return mesh(MeshFormat::kMsh);
  if (is_medit(head)) return mesh(MeshFormat::kMedit);
  const ForeignFormat foreign = foreign_format(head);
  return foreign.name.empty() ? std::nullopt : std::optional(MarkedContent{MeshFormat::kUnknown, foreign.name});
}

MeshFormat detect_format(ContentSource& source, const std::string& path) {
  if (is_cx_name(path)) return MeshFormat::kCx;
  if (!source.size())
    for (const std::size_t min_bytes : {1u, 80u}) {
      const std::string_view head = source.view(0, min_bytes);
      if (may_be_big_endian_nifti(head)) break;
      if (starts_streaming(head, path)) return MeshFormat::kStreaming;
    }
  if (const auto marked = marked_content(source)) return marked->format;
  const std::string_view head = without_byte_order_mark(source.view(0));
  if (parse_off_keyword(first_word(skip_comments(head)))) return MeshFormat::kOff;
  if (has_binary_stl_size(head, source.size()) && content_suffix(path) == ".stl") return MeshFormat::kBinaryStl;
  if (is_streaming_binary(head) || announces_stream(head, path)) return MeshFormat::kStreaming;
  const bool text = is_text(head);
  if (starts_with_solid(head)) return text ? MeshFormat::kAsciiStl : MeshFormat::kBinaryStl;
  if (text) return detect_text(head, path);
  if (is_streaming_name(path)) return MeshFormat::kStreaming;
  // A size that is known is that of a binary STL file, unless it is cut; then the name must say what it is.
  const bool may_be_stl = !source.size() || content_suffix(path) == ".stl";
  if (may_be_stl && looks_like_binary_stl(head)) return MeshFormat::kBinaryStl;
  const bool too_short_for_stl = head.size() < BinaryStlReader::kHeaderBytes;
  return too_short_for_stl && starts_like_stream(head) ? MeshFormat::kStreaming : MeshFormat::kUnknown;
}

std::optional<std::size_t> bare_return(ContentSource& source, MeshFormat format) {
  if (format == MeshFormat::kVtkXml || format == MeshFormat::kMedit) return {};  // CR is a blank there
  std::string_view head = source.view(0, 1);
  if (format == MeshFormat::kPly) head = head.substr(0, head.find("end_header"));  // its body can be binary
  const std::size_t first = head.find('\r');
  const bool is_bare = first != std::string_view::npos && head.find('\n') == std::string_view::npos && is_text(head) &&
                       !first_word(head.substr(first)).empty();
  return is_bare ? std::optional(first) : std::nullopt;
}

bool is_text_stl(ContentSource& source) {
  const std::string_view head = source.view(0);
  return !has_binary_stl_size(head, source.size()) && starts_with_solid(head) && is_text(head);
}

std::string_view format_name(MeshFormat format) {
  switch (format) {
    case MeshFormat::kPly:
      return "PLY";
    case MeshFormat::kOff:
      return "OFF";
    case MeshFormat::kAsciiStl:
    case MeshFormat::kBinaryStl:
      return "STL";
    case MeshFormat::kObj:
      return "OBJ";
    case MeshFormat::kStreaming:
      return "a streaming mesh";
    case MeshFormat::kCx:
      return "CX";
    case MeshFormat::kVtkLegacy:
      return "VTK";
    case MeshFormat::kVtkXml:
      return "VTK XML";
    case MeshFormat::kMsh:
      return "MSH";
    case MeshFormat::kMedit:
      return "Medit";
    case MeshFormat::kTetgen:
      return "TetGen";
    case MeshFormat::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace reeb::io
