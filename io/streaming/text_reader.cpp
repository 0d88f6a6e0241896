#include "io/streaming/text_reader.h"

#include "io/events/stream_fault.h"
#include "io/streaming/text_head.h"

namespace reeb::io {
namespace {

constexpr std::size_t kEventsPerFill = 128;
constexpr std::uint64_t kSkippedInFull = 5;

bool starts_with_letter(std::string_view line, char letter) {
  return line.size() >= 2 && line[0] == letter && (line[1] == ' ' || line[1] == '\t');
}

}  // namespace

TextEventReader::TextEventReader(Cursor cursor, bool volume) : cursor_(std::move(cursor)), lines_(cursor_) {
  header_.volume = volume;
  read_head();
}

TextEventReader::Line TextEventReader::classify(std::string_view line) const {
  if (line.find_first_not_of(" \t") == std::string_view::npos) return Line::kEmpty;
  if (line[0] == '#') return Line::kHash;
  if (starts_with_letter(line, 'v')) return Line::kVertex;
  if (starts_with_letter(line, header_.volume ? 'c' : 'f')) return Line::kCell;
  if (starts_with_letter(line, 'x')) return Line::kFinal;
  return Line::kUnknown;
}

void TextEventReader::read_head() {
  TextHead head(header_);
  while (const auto line = lines_.next()) {
    const Line kind = classify(*line);
    if (kind == Line::kHash) head.read_line(*line, lines_.number());
    if (kind == Line::kUnknown) skip_unknown(*line);
    if (kind == Line::kVertex || kind == Line::kCell || kind == Line::kFinal) {
      has_body_ = true;
      header_.post_order = kind == Line::kCell;
      lines_.put_back();
      break;
    }
  }
  head.finish();
  rules_.set_post_order(header_.post_order);
}

void TextEventReader::skip_unknown(std::string_view line) {
  if (++skipped_ > kSkippedInFull) return;
  std::string text = "SKIPPED: line " + std::to_string(lines_.number()) + ": '" + std::string(line.substr(0, 60)) + "'";
  if (!header_.volume && starts_with_letter(line, 'c'))
    text += " (looks like a volume mesh, but no line '# svtype tet' says so)";
  if (header_.volume && starts_with_letter(line, 'f')) text += " (looks like a surface mesh)";
  if (header_.volume && starts_with_letter(line, 'p')) text += " (looks like a point cloud)";
  warn(std::move(text));
}

std::vector<std::string> TextEventReader::warnings() const {
  auto all = EventReader::warnings();
  if (skipped_ > kSkippedInFull) all.push_back("SKIPPED: " + std::to_string(skipped_) + " unknown lines in all");
  return all;
}

void TextEventReader::fill() {
  while (!done_ && queued() < kEventsPerFill) {
    const auto line = lines_.next();
    if (!line) return finish();
    switch (classify(*line)) {
      case Line::kVertex:
        read_vertex(*line);
        break;
      case Line::kCell:
        read_cell(*line);
        break;
      case Line::kFinal:
        read_finalization(*line);
        break;
      case Line::kUnknown:
        skip_unknown(*line);
        break;
      case Line::kHash:
      case Line::kEmpty:
        break;
    }
  }
}

std::string TextEventReader::place(const LineCursor& cursor) const {
  return std::to_string(lines_.number()) + ":" + std::to_string(cursor.column());
}

void TextEventReader::require(NumberVerdict verdict, const char* what, const LineCursor& cursor) const {
  const std::string word(cursor.last_word().substr(0, 60));
  switch (verdict) {
    case NumberVerdict::kValid:
      return;
    case NumberVerdict::kMissing:
      fail(Fault::kBadNumber,
           std::string(what) + " is missing" + (lines_.unfinished() ? " (the file may be cut off)" : ""),
           place(cursor));
    case NumberVerdict::kNotANumber:
      fail(Fault::kBadNumber,
           std::string(what) + " is not a number: '" + word + "'" +
               (lines_.unfinished() ? " (the file may be cut off)" : ""),
           place(cursor));
    case NumberVerdict::kOutOfRange:
      fail(Fault::kBadNumber, std::string(what) + " is out of range: '" + word + "'", place(cursor));
  }
}

void TextEventReader::read_vertex(std::string_view line) {
  static constexpr std::array kCoordinates = {"first coordinate", "second coordinate", "third coordinate"};
  LineCursor cursor(line, 1);
  std::array<float, kMaxFloats> floats{};
  std::array<std::int32_t, kMaxInts> ints{};
  for (std::size_t i = 0; i < header_.vertex_floats; ++i)
    require(cursor.number(floats[i]), i < 3 ? kCoordinates[i] : "value of the vertex", cursor);
  for (std::size_t i = 0; i < header_.vertex_ints; ++i)
    require(cursor.number(ints[i]), "integer value of the vertex", cursor);
  surplus_ |= !cursor.at_end();
  if (rules_.vertex_count() == kMaxVertices) fail(Fault::kBadIndex, "more than 2147483647 vertices", place(cursor));

  StreamEvent& event = push(EventKind::kVertex);
  event.vertex = rules_.vertex_count();
  event.floats = floats;
  event.ints = ints;
  rules_.add_vertex();
  if (rules_.post_order()) push_finalized(event.vertex);
}

TextEventReader::Corner TextEventReader::read_corner(LineCursor& cursor, std::size_t corner,
                                                     const std::array<Corner, 4>& earlier) {
  std::int32_t number = 0;
  const std::string who = "corner " + std::to_string(corner + 1);
  const NumberVerdict verdict = cursor.number(number);
  if (verdict == NumberVerdict::kNotANumber && !header_.volume &&
      cursor.last_word().find('/') != std::string_view::npos)
    fail(Fault::kNotTriangle, "corners with '/' as in OBJ files are not read", place(cursor));
  if (verdict == NumberVerdict::kOutOfRange)
    fail(Fault::kBadIndex, who + " is out of range: '" + std::string(cursor.last_word()) + "'", place(cursor));
  require(verdict, who.c_str(), cursor);
  Corner result{0, number < 0};
  const IndexVerdict index = rules_.corner(number, result.vertex);
  if (index != IndexVerdict::kValid) rules_.fail_index(index, number, who, place(cursor));
  for (std::size_t i = 0; i < corner; ++i)
    if (result.final && earlier[i].final && earlier[i].vertex == result.vertex)
      rules_.fail_index(IndexVerdict::kFinal, number, who, place(cursor));
  return result;
}

void TextEventReader::read_cell(std::string_view line) {
  LineCursor cursor(line, 1);
  const std::size_t size = header_.volume ? 4 : 3;
  std::array<Corner, 4> corners{};
  for (std::size_t i = 0; i < size; ++i) corners[i] = read_corner(cursor, i, corners);
  std::array<float, kMaxFloats> floats{};
  std::array<std::int32_t, kMaxInts> ints{};
  for (std::size_t i = 0; i < header_.cell_floats; ++i) require(cursor.number(floats[i]), "value of the cell", cursor);
  for (std::size_t i = 0; i < header_.cell_ints; ++i)
    require(cursor.number(ints[i]), "integer value of the cell", cursor);
  if (!cursor.at_end()) {
    if (!header_.volume)
      fail(Fault::kNotTriangle, "polygon with more than 3 corners; only triangles are supported", place(cursor));
    surplus_ = true;
  }

  ++cells_;
  StreamEvent& event = push(header_.volume ? EventKind::kTetrahedron : EventKind::kTriangle);
  for (std::size_t i = 0; i < size; ++i) event.corners[i] = corners[i].vertex;
  event.floats = floats;
  event.ints = ints;
  for (std::size_t i = 0; i < size; ++i) {
    if (!corners[i].final) continue;
    rules_.finalize(corners[i].vertex);
    push_finalized(corners[i].vertex);
  }
}

void TextEventReader::read_finalization(std::string_view line) {
  LineCursor cursor(line, 1);
  std::int32_t number = 0;
  std::uint32_t vertex = 0;
  const NumberVerdict verdict = cursor.number(number);
  if (verdict == NumberVerdict::kOutOfRange)
    fail(Fault::kBadIndex, "the finalized vertex is out of range", place(cursor));
  require(verdict, "the finalized vertex", cursor);
  const IndexVerdict index = rules_.finalization(number, vertex);
  if (index != IndexVerdict::kValid) rules_.fail_index(index, number, "finalization", place(cursor));
  rules_.finalize(vertex);
  push_finalized(vertex);
}

void TextEventReader::finish() {
  done_ = true;
  const std::string end = std::to_string(lines_.number() + 1) + ":1";
  rules_.require_all_arrived(cell_name(), end);
  const Tally vertices{header_.vertex_count, rules_.vertex_count()};
  const Tally cells{header_.cell_count, cells_};
  require_promised(vertices, "vertices", end);
  require_promised(cells, cell_name(), end);
  for (auto text : {count_warning(vertices, "vertices", false), count_warning(cells, cell_name(), false)})
    if (!text.empty()) warn(std::move(text));
  if (surplus_) warn("EXTRA: surplus numbers on lines were ignored");
}

}  // namespace reeb::io
