#include "io/formats/cx_reader.h"

#include <utility>

#include "io/file/file_name.h"
#include "io/text/hints.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

constexpr std::size_t kMostCoordinates = 9;
constexpr const char* kItemHint = "a line is `v x1 ... xd` or `s i j ...`; the file may be cut or damaged here";

}  // namespace

bool is_cx_name(const std::string& path) { return content_suffix(path) == ".cx"; }

CxReader::CxReader(std::unique_ptr<ContentSource> source, ReadOptions options)
    : BatchReader(std::move(options)), text_(std::move(source), {.comments = true}) {
  refuse_properties(this->options(), "CX", text_.source().name());
  info_.format = "CX";
  info_.file_bytes = text_.source().file_bytes();
  if (!text_.more()) return;
  if (const std::string_view keyword = text_.token(); keyword != "v")
    text_.fail(keyword == "s" ? "a simplex comes before all vertices" : "the first item is not a vertex", kItemHint);
  last_item_line_ = text_.line();
  read_numbers();
  info_.dimension = static_cast<unsigned>(numbers_.size());
  first_waits_ = true;
}

void CxReader::fill(MeshBatch& batch) {
  if (std::exchange(first_waits_, false)) add_vertex(batch);
  while (room<kMaxSimplexDimension>(batch) != 0 && read_line(batch)) continue;
}

bool CxReader::read_line(MeshBatch& batch) {
  if (!text_.more()) {
    has_open_line_ = last_item_line_ == text_.line();
    return false;
  }
  const std::string_view keyword = text_.token();
  last_item_line_ = text_.line();
  if (keyword == "v") {
    read_numbers();
    if (numbers_.size() != info_.dimension)
      text_.fail("a vertex of " + count_of(numbers_.size(), "coordinate") + ", but the first has " +
                     std::to_string(info_.dimension),
                 "all vertices have the same number of coordinates; the file may be cut or damaged here");
    add_vertex(batch);
  } else if (keyword == "s") {
    read_simplex(batch);
  } else {
    text_.fail("a line begins with neither v nor s", kItemHint);
  }
  return true;
}

std::vector<std::string> CxReader::warnings() const {
  if (has_open_line_) return {kOpenLineNote};
  return {};
}

void CxReader::read_numbers() {
  numbers_.clear();
  do {
    if (numbers_.size() == kMostCoordinates) {
      text_.mark();
      text_.fail("a vertex of more than 9 coordinates", "a vertex has 1 to 9 coordinates");
    }
    numbers_.push_back(text_.finite_number<double>("coordinate"));
  } while (text_.more_on_line());
}

void CxReader::add_vertex(MeshBatch& batch) {
  for (std::size_t k = 0; k < numbers_.size(); ++k) batch.coordinates[k].push_back(numbers_[k]);
  count_vertices(batch, 1);
}

void CxReader::read_simplex(MeshBatch& batch) {
  corners_.clear();
  do {
    corners_.push_back(read_corner());
  } while (text_.more_on_line());
  std::vector<VertexId>& all = batch.simplices[corners_.size() - 1];
  all.insert(all.end(), corners_.begin(), corners_.end());
}

VertexId CxReader::read_corner() {
  text_.more_on_line();
  text_.mark();
  if (corners_.size() > kMaxSimplexDimension)
    text_.fail("a simplex of more than 9 vertices", "a simplex has 1 to 9 vertices");
  std::uint64_t number = 0;
  constexpr const char* kIndexHint = "a vertex is named by its index, from 0";
  if (!text_.digits(number)) text_.fail_digits("vertex index", kIndexHint);
  if (const char next = text_.peek(); next != '\n' && next != '#' && !is_blank(next))
    text_.fail("a vertex index should be here", kIndexHint);
  if (number >= vertices_read())
    text_.fail("a simplex names vertex " + std::to_string(number) + ", but only " +
                   count_of(vertices_read(), "vertex") + " came before it",
               "vertices are numbered from 0; put each simplex after its vertices");
  return VertexId(number);
}

}  // namespace reeb::io
