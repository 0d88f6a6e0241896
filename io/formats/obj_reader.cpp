#include "io/formats/obj_reader.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/text/hints.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// Sorted. Lines without simplices: free-form geometry, groups, materials and rendering state.
constexpr auto kSkippedKeywords = std::to_array<std::string_view>(
    {"bevel",  "bmat",  "bsp",    "bzp",       "c_interp", "call",   "cdc",    "cdp",  "con",        "csh",
     "cstype", "ctech", "curv",   "curv2",     "d_interp", "deg",    "end",    "g",    "hole",       "lod",
     "maplib", "mg",    "mtllib", "o",         "parm",     "res",    "s",      "scrv", "shadow_obj", "sp",
     "stech",  "step",  "surf",   "trace_obj", "trim",     "usemap", "usemtl", "vn",   "vp",         "vt"});
static_assert(std::ranges::is_sorted(kSkippedKeywords));

bool is_skipped(std::string_view word) { return std::ranges::binary_search(kSkippedKeywords, word); }

}  // namespace

bool is_obj_keyword(std::string_view word) {
  return word == "v" || word == "f" || word == "fo" || word == "l" || word == "p" || is_skipped(word);
}

ObjReader::ObjReader(std::unique_ptr<ContentSource> source, ReadOptions options)
    : BatchReader(std::move(options)), text_(std::move(source), {.comments = true, .continuation = true}) {
  refuse_properties(this->options(), "OBJ", text_.source().name());
  if (this->options().signed_zeros) text_.keep_signed_zeros();
  info_.format = "OBJ";
  info_.file_bytes = text_.source().file_bytes();
}

void ObjReader::fill(MeshBatch& batch) {
  while (room(batch) != 0) {
    if (in_face_)
      read_corner(batch);
    else if (read_plain_vertex(batch) || read_plain_face(batch))
      continue;
    else if (text_.more())
      begin_line(batch);
    else
      return finish();
  }
}

// A file of comments is a mesh without vertices.
void ObjReader::finish() {
  has_open_line_ = last_item_line_ == text_.line();
  if (has_obj_line_ || unknown_lines_ == 0) return;
  throw Error(ErrorKind::kBadInput, "none of its lines is OBJ",
              "it may be of another format: leave --format out, or give the right one")
      .at(text_.source().name(), std::to_string(first_unknown_line_) + ":1");
}

// Reads a vertex of three coordinates. Returns false if the line is something else, or has another form.
bool ObjReader::read_plain_vertex(MeshBatch& batch) {
  std::array<double, 3> point{};
  if (!text_.plain_line([&](PlainLine& line) { return line.letter('v') && line.point(point); })) return false;
  add_vertex(point, batch);
  return true;
}

// The same for a face of three or four vertices that have come before.
bool ObjReader::read_plain_face(MeshBatch& batch) {
  std::array<std::uint64_t, 4> corners{};
  std::size_t count = 0;
  const auto read = [&](PlainLine& line) {
    if (!line.letter('f')) return false;
    for (; line.more(); ++count) {
      if (count == corners.size() || !line.corner(corners[count])) return false;
      if (corners[count] == 0 || corners[count] > vertices_read()) return false;
    }
    return count >= 3 && room(batch) >= count - 2;
  };
  if (!text_.plain_line(read)) return false;
  has_obj_line_ = true;
  for (std::size_t k = 2; k < count; ++k)
    for (const std::uint64_t corner : {corners[0], corners[k - 1], corners[k]})
      batch.triangles().push_back(VertexId(corner - 1));
  return true;
}

void ObjReader::begin_line(MeshBatch& batch) {
  const std::string_view keyword = text_.token();
  if (keyword == "v") {
    last_item_line_ = text_.line();
    read_vertex(batch);
  } else if (keyword == "f" || keyword == "l" || keyword == "fo" || keyword == "p") {
    has_obj_line_ = true;
    last_item_line_ = text_.line();
    const std::string name(keyword);  // more_on_line() may move the text
    if (!text_.more_on_line()) text_.fail('"' + name + "\" without a vertex", kCutOrDamagedHereHint);
    face_.begin(name == "l" ? FaceShape::kPolyline : name == "p" ? FaceShape::kPoints : FaceShape::kPolygon);
    in_face_ = true;
  } else {
    if (is_skipped(keyword))
      note_skipped(keyword);
    else if (unknown_lines_++ == 0)
      first_unknown_line_ = text_.line();
    text_.skip_line();
  }
}

void ObjReader::note_skipped(std::string_view keyword) {
  has_obj_line_ = true;
  if (keyword == "vn")
    skipped_.normals = true;
  else if (keyword == "vt")
    skipped_.texture = true;
  else if (keyword == "g" || keyword == "o" || keyword == "s" || keyword == "mg")
    skipped_.groups = true;
  else if (keyword == "usemtl" || keyword == "mtllib")
    skipped_.materials = true;
}

void ObjReader::read_vertex(MeshBatch& batch) {
  std::array<double, 3> point{};
  for (double& coordinate : point) coordinate = text_.finite_number<double>("coordinate");
  unsigned numbers = 3;
  for (; text_.more_on_line(); ++numbers)
    if (spells_non_finite(text_.token())) ++non_finite_extras_;
  if (numbers == 5 || numbers > 7)
    text_.fail("a vertex of " + std::to_string(numbers) + " numbers",
               "a vertex has 3 coordinates, and perhaps a weight or a colour of 3 or 4 numbers");
  text_.skip_line();
  if (numbers >= 6) skipped_.colors = true;
  add_vertex(point, batch);
}

void ObjReader::add_vertex(const std::array<double, 3>& point, MeshBatch& batch) {
  has_obj_line_ = true;
  for (std::size_t k = 0; k < 3; ++k) batch.coordinates[k].push_back(point[k]);
  count_vertices(batch, 1);
}

void ObjReader::read_corner(MeshBatch& batch) {
  if (text_.more_on_line()) {
    face_.add(corner(), batch);
    return;
  }
  face_.end(batch);
  in_face_ = false;
  text_.skip_line();
}

VertexId ObjReader::corner() {
  text_.mark();
  const bool negative = text_.peek() == '-';
  if (negative) text_.advance();
  std::uint64_t number = 0;
  if (!text_.digits(number)) text_.fail_digits("vertex number", kCutOrDamagedHereHint);
  if (text_.peek() == '/') skip_texture_and_normal();
  const char next = text_.peek();
  if (next != '\n' && next != '\\' && next != '#' && !is_blank(next))
    text_.fail("a face corner is not of the form a, a/t, a//n or a/t/n", kCutOrDamagedHereHint);
  if (number == 0 || number > vertices_read()) fail_corner(negative, number);
  return VertexId(negative ? vertices_read() - number : number - 1);
}

void ObjReader::skip_texture_and_normal() {
  for (char c = text_.peek(); c == '/' || c == '-' || (c >= '0' && c <= '9'); c = text_.peek()) text_.advance();
}

void ObjReader::fail_corner(bool negative, std::uint64_t number) const {
  const std::string name = (negative ? "-" : "") + std::to_string(number);
  if (number == 0) text_.fail("a face names vertex 0", "vertices are numbered from 1");
  text_.fail("a face names vertex " + name + ", but only " + count_of(vertices_read(), "vertex") + " came before it",
             "put each face after its vertices; if the vertex never comes, the file is damaged");
}

std::vector<std::string> ObjReader::warnings() const {
  std::vector<std::string> lines;
  if (options().names_losses) {
    std::string names;
    for (const auto& [is_there, name] :
         {std::pair(skipped_.normals, "normals"), std::pair(skipped_.texture, "texture coordinates"),
          std::pair(skipped_.colors, "colours"), std::pair(skipped_.groups, "groups"),
          std::pair(skipped_.materials, "materials")})
      if (is_there) names.append(names.empty() ? "" : ", ").append(name);
    if (!names.empty()) lines.push_back("not kept from the OBJ file: " + names);
  }
  if (unknown_lines_ != 0)
    lines.push_back(count_of(unknown_lines_, "unknown line") +
                    (unknown_lines_ == 1 ? " was skipped: line " : " were skipped, the first is line ") +
                    std::to_string(first_unknown_line_));
  if (non_finite_extras_ != 0)
    lines.push_back(count_of(non_finite_extras_, "number") + " for weights or colours, which are not used, " +
                    (non_finite_extras_ == 1 ? "is" : "are") + " not finite");
  if (has_open_line_) lines.emplace_back(kOpenLineNote);
  return lines;
}

}  // namespace reeb::io
