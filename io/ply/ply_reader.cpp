#include "io/ply/ply_reader.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "io/mesh/property_columns.h"
#include "io/mesh/simplex_assembler.h"
#include "io/ply/ply_decoder.h"
#include "io/ply/ply_indexed.h"
#include "io/text/hints.h"
#include "libreeb/base/count_text.h"

namespace reeb::io {
namespace {

constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

// One pass over an element. There can be two passes over the file.
struct Step {
  std::size_t element = 0;
  bool deliver = false;    // else skip it
  bool from_body = false;  // start again at the first element
};

// In the order of the file, unless there are faces before the vertices.
std::vector<Step> plan_steps(const PlyHeader& header) {
  std::vector<Step> steps;
  const auto& elements = header.elements;
  const auto names_corners = [](const PlyElement& e) {
    return (e.role == PlyRole::kFaces || e.role == PlyRole::kStrips) && e.count != 0;
  };
  const auto vertices = elements.begin() + static_cast<std::ptrdiff_t>(header.vertex_element);
  const bool faces_first = std::any_of(elements.begin(), vertices, names_corners);
  if (faces_first)
    for (std::size_t i = 0; i <= header.vertex_element; ++i) steps.push_back({i, i == header.vertex_element, false});
  for (std::size_t i = 0; i < elements.size(); ++i)
    steps.push_back({i, !(faces_first && i == header.vertex_element), faces_first && i == 0});
  return steps;
}

MeshInfo describe(const PlyHeader& header, const ContentSource& source) {
  MeshInfo info;
  info.format = header.format();
  info.dimension = header.dimension;
  info.property_names = header.property_names();
  info.vertex_count = header.vertices().count;
  info.simplex_count = 0;
  for (const PlyElement& element : header.elements) {
    if (element.role == PlyRole::kFaces && info.simplex_count) *info.simplex_count += element.count;
    if (element.role == PlyRole::kStrips) info.simplex_count.reset();  // unknown: a strip has any number of triangles
  }
  info.float32 = std::ranges::all_of(header.vertices().properties,
                                     [](const PlyProperty& property) { return fits_float32(property.type); });
  info.file_bytes = source.file_bytes();
  return info;
}

// One column of records of fixed size; its first value is at `bytes`.
struct ColumnBytes {
  ScalarType type;
  bool swap;
  const char* bytes;
  std::size_t stride;
};

// Appends `count` values to `column`. `zero` is added to each. Returns whether all are finite.
bool append_column(const ColumnBytes& from, std::size_t count, double zero, std::vector<double>& column) {
  const std::size_t before = column.size();
  column.resize(before + count);
  double* const out = column.data() + before;
  with_type(from.type, [&](auto none) {
    for (std::size_t i = 0; i < count; ++i)
      out[i] = static_cast<double>(load_scalar<decltype(none)>(from.bytes + i * from.stride, from.swap)) + zero;
  });
  return all_finite({out, count});
}

std::uint64_t count_non_finite(std::span<const double> values) {
  return static_cast<std::uint64_t>(std::ranges::count_if(values, [](double value) { return !std::isfinite(value); }));
}

// The part of a place after the offset of its record, in 64 bits.
struct Within {
  std::size_t step = 0, triangles = 0;  // triangles of the record before the place
  std::uint64_t record = 0;

  bool fits() const { return step < 256 && triangles < 65536 && record >> 40 == 0; }
  std::uint64_t packed() const { return record << 24 | triangles << 8 | step; }
  static Within unpacked(std::uint64_t bits) {
    return {static_cast<std::size_t>(bits & 0xff), static_cast<std::size_t>(bits >> 8 & 0xffff), bits >> 24};
  }
};

template <class Decoder>
class PlyReader final : public PlyBodyReader {
 public:
  PlyReader(TextCursor text, PlyHeader header, ReadOptions options)
      : PlyBodyReader(std::move(options)),
        header_(std::move(header)),
        steps_(plan_steps(header_)),
        decoder_(std::move(text), header_),
        vertex_limit_(header_.vertices().count) {
    info_ = describe(header_, decoder_.source());
    name_all_properties();
    choose_columns();
    if (this->options().signed_zeros) decoder_.keep_signed_zeros();
    if (std::ranges::any_of(steps_, &Step::from_body) && !decoder_.source().can_seek())
      throw Error(ErrorKind::kBadInput, "the faces come before their vertices, and the input can be read only once",
                  "unpack it to a file, or write the element vertex before the element face")
          .at(decoder_.source().name());
  }

  void deliver_triangles_only() { triangles_only_ = true; }

  void move_to_faces() override {
    turned_ = {};
    std::uint64_t offset = header_.body_offset;
    for (step_ = 0; step_ <= header_.vertex_element; ++step_)
      offset += header_.elements[step_].count * header_.elements[step_].fixed_bytes();
    decoder_.bytes().move_to(offset);
    record_ = non_finite_values_ = 0;
    in_record_ = trailing_ = false;
  }

  std::array<std::uint64_t, 2> points_and_edges() const override { return turned_; }

  std::optional<MeshPlace> place() const override {
    if constexpr (Decoder::kBinary) {
      const Within within{step_, in_record_ ? of_record_ : 0, record_};
      if (within.fits()) return MeshPlace{in_record_ ? record_begin_ : decoder_.offset(), within.packed()};
    }
    return std::nullopt;
  }

  void seek(const MeshPlace& place) override {
    const Within within = Within::unpacked(place.second);
    decoder_.bytes().move_to(place.first);
    step_ = within.step;
    record_ = within.record;
    in_record_ = expects_triangles_ = false;
    if (within.triangles == 0) return;
    MeshBatch passed;
    set_batch_events(within.triangles);
    read(passed);
  }

  void seek_triangle(const PlyTriangles& triangles, std::uint64_t number) override {
    decoder_.bytes().move_to(triangles.offset + number * triangles.bytes);
    step_ = triangles.element;
    record_ = number;
    in_record_ = false;
    expects_triangles_ = true;
  }

  std::unique_ptr<IndexedMesh> indexed() const override {
    auto file = decoder_.source().file();
    if (file == nullptr || !has_indexed_vertices(header_)) return nullptr;
    return index_ply(std::move(file), header_, options(), carried_);
  }

  std::uint64_t bytes_read() const override { return decoder_.bytes_read(); }

  std::vector<std::string> warnings() const override {
    std::vector<std::string> lines;
    if (non_finite_values_ != 0) lines.push_back(note_on_non_finite_values(non_finite_values_));
    for (const PlyElement& element : header_.elements)
      if (element.name == "edge" && element.count != 0)
        lines.push_back(count_of(element.count, "edge") + (element.count == 1 ? " was" : " were") +
                        " ignored: of PLY, vertices, faces and strips are read");
    if (header_.unknown_lines != 0)
      lines.push_back(count_of(header_.unknown_lines, "line") + " of the header " +
                      (header_.unknown_lines == 1 ? "is" : "are") + " not PLY and " +
                      (header_.unknown_lines == 1 ? "was" : "were") + " ignored");
    if (const std::uint64_t surplus = decoder_.surplus_values(); surplus != 0)
      lines.push_back(count_of(surplus, "value") + " at the end of lines " + (surplus == 1 ? "was" : "were") +
                      " ignored: the header does not declare " + (surplus == 1 ? "it" : "them"));
    if (trailing_)
      lines.push_back(std::string(Decoder::kBinary ? "bytes" : "lines") +
                      " after the last element were ignored: the header does not announce them");
    return lines;
  }

 private:
  void choose_columns() {
    column_of_.assign(header_.vertices().properties.size(), kNoColumn);
    const auto take = [this](std::size_t property) {
      if (column_of_[property] == kNoColumn)
        column_of_[property] = columns_.size();
      else
        copies_.emplace_back(columns_.size(), column_of_[property]);
      columns_.push_back(nullptr);
    };
    for (const std::size_t property : header_.coordinate_properties()) take(property);
    for (const std::size_t property : header_.find_properties(options().properties, decoder_.source().name()))
      take(property);
    carried_.resize(info_.dimension, false);
    for (const std::string& name : options().properties) carried_.push_back(is_carried(name));
  }

  void fill(MeshBatch& batch) override {
    for (std::size_t k = 0; k < columns_.size(); ++k) columns_[k] = &batch.column(k);
    while (room(batch) != 0 && step_ < steps_.size()) {
      const Step& step = steps_[step_];
      const PlyElement& element = header_.elements[step.element];
      if (record_ == 0 && !in_record_ && step.from_body) decoder_.move_to_body();
      if (!step.deliver || element.role == PlyRole::kSkipped)
        pass_element(element);
      else if (element.role == PlyRole::kVertices)
        read_vertices(element, batch);
      else
        read_faces(element, batch);
      if (record_ == element.count) next_step();
    }
  }

  void next_step() {
    ++step_;
    record_ = 0;
    if (step_ == steps_.size()) trailing_ = decoder_.has_more();
  }

  void pass_element(const PlyElement& element) {
    if constexpr (Decoder::kBinary) {
      if (!element.has_lists()) {
        pass_fixed_records(element);
        return;
      }
    }
    for (; record_ != element.count; ++record_) {
      decoder_.begin_record(element);
      for (const PlyProperty& property : element.properties) pass_property(property);
      decoder_.end_record(element);
    }
  }

  void pass_fixed_records(const PlyElement& element) {
    const std::size_t stride = element.fixed_bytes();
    if (stride > ContentSource::kLookahead)
      decoder_.fail("a record of the element " + element.name + " has more than 65,536 bytes",
                    "check the lines \"property\" of this element in the header");
    for (; record_ != element.count; ++record_) decoder_.take(stride);
  }

  void pass_property(const PlyProperty& property) {
    const std::uint64_t values = property.list_count ? list_length(property) : 1;
    for (std::uint64_t i = 0; i < values; ++i) decoder_.skip(property.type, "value");
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const std::int64_t length = decoder_.integer(*property.list_count, "list length");
    if (length < 0) decoder_.fail("a list has a negative length", kDamagedHereHint);
    return static_cast<std::uint64_t>(length);
  }

  // --- vertices

  void read_vertices(const PlyElement& element, MeshBatch& batch) {
    const bool plain =
        !element.has_lists() && (!Decoder::kBinary || element.fixed_bytes() <= ContentSource::kLookahead);
    while (room(batch) != 0 && record_ != element.count)
      if (!plain || !read_plain_vertices(element, batch)) read_vertex(element, batch);
  }

  // Returns false if the next line of text is not plain: read_vertex() then finds out why.
  bool read_plain_vertices(const PlyElement& element, MeshBatch& batch) {
    if constexpr (Decoder::kBinary) {
      read_vertex_run(element, batch);
      return true;
    } else {
      return read_plain_vertex(element, batch);
    }
  }

  bool read_plain_vertex(const PlyElement& element, MeshBatch& batch) {
    scratch_.resize(element.properties.size());
    if (!decoder_.plain_values(element, scratch_)) return false;
    for (std::size_t p = 0; p < scratch_.size(); ++p)
      if (column_of_[p] != kNoColumn) columns_[column_of_[p]]->push_back(scratch_[p]);
    end_vertices(batch, 1);
    return true;
  }

  // Ends `count` vertices whose values are read: fills the columns that were requested twice, and counts the vertices.
  void end_vertices(MeshBatch& batch, std::size_t count) {
    for (const auto& [to, from] : copies_)
      columns_[to]->insert(columns_[to]->end(), columns_[from]->end() - static_cast<std::ptrdiff_t>(count),
                           columns_[from]->end());
    record_ += count;
    count_vertices(batch, count);
  }

  void read_vertex(const PlyElement& element, MeshBatch& batch) {
    decoder_.begin_record(element);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (column_of_[p] != kNoColumn)
        columns_[column_of_[p]]->push_back(read_value(property.type, p));
      else if (property.list_count)
        pass_property(property);
      else
        non_finite_values_ += decoder_.skip(property.type, "value") ? 1u : 0u;
    }
    decoder_.end_record(element);
    end_vertices(batch, 1);
  }

  double read_value(ScalarType type, std::size_t property) {
    if (!carried_[column_of_[property]]) return decoder_.finite_value(type, what_is(property));
    const double value = decoder_.any_value(type, what_is(property));
    non_finite_values_ += std::isfinite(value) ? 0u : 1u;
    return value;
  }

  const char* what_is(std::size_t property) const {
    return column_of_[property] < info_.dimension ? "coordinate" : "vertex property";
  }

  // Reads many records of fixed size at once, column by column.
  void read_vertex_run(const PlyElement& element, MeshBatch& batch) {
    const std::size_t stride = element.fixed_bytes();
    Cursor& bytes = decoder_.bytes();
    if (!bytes.ensure(stride)) decoder_.take(stride);  // fails
    const auto left = static_cast<std::size_t>(std::min<std::uint64_t>(element.count - record_, room(batch)));
    const std::size_t count = std::min({left, bytes.available() / stride, kRunRecords});
    std::size_t place = 0;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const ScalarType type = element.properties[p].type;
      const char* const first = bytes.data() + place;
      if (column_of_[p] == kNoColumn)
        count_non_finite_values(type, first, stride, count);
      else if (!append_column({type, decoder_.swaps(), first, stride}, count, zero(), *columns_[column_of_[p]]))
        meet_non_finite_values(p, place, stride, count);
      place += byte_size(type);
    }
    bytes.advance(count * stride);
    end_vertices(batch, count);
  }

  void count_non_finite_values(ScalarType type, const char* first, std::size_t stride, std::size_t count) {
    if (!is_float(type)) return;
    scratch_.clear();
    if (!append_column({type, decoder_.swaps(), first, stride}, count, zero(), scratch_))
      non_finite_values_ += count_non_finite(scratch_);
  }

  // The last `count` values of the column of `property` are not all finite.
  void meet_non_finite_values(std::size_t property, std::size_t place, std::size_t stride, std::size_t count) {
    if (!carried_[column_of_[property]]) fail_not_finite(property, place, stride, count);
    non_finite_values_ += count_non_finite(std::span(*columns_[column_of_[property]]).last(count));
  }

  [[noreturn]] void fail_not_finite(std::size_t property, std::size_t place, std::size_t stride, std::size_t count) {
    const auto& column = *columns_[column_of_[property]];
    const auto non_finite = std::find_if(column.end() - static_cast<std::ptrdiff_t>(count), column.end(),
                                         [](double value) { return !std::isfinite(value); });
    const auto index = count - static_cast<std::size_t>(column.end() - non_finite);
    decoder_.fail_at(
        decoder_.bytes().offset() + index * stride + place,
        std::string("a ") + what_is(property) + " of vertex " + std::to_string(record_ + index) + " is not finite",
        "fix this value in the file");
  }

  // --- faces and strips

  void read_faces(const PlyElement& element, MeshBatch& batch) {
    const bool plain = is_plain(element);
    while (room(batch) != 0 && record_ != element.count) {
      if (plain && !in_record_ && read_triangle_run(element, batch)) continue;
      advance_face(element, batch);
    }
  }

  // Advances a face by one step: to its next property, or through its corners while there is room.
  void advance_face(const PlyElement& element, MeshBatch& batch) {
    if (!std::exchange(in_record_, true)) {
      decoder_.begin_record(element);
      property_ = 0;
      in_list_ = false;
      if constexpr (Decoder::kBinary) record_begin_ = decoder_.offset();
      of_record_ = 0;
    }
    if (property_ == element.properties.size()) {
      decoder_.end_record(element);
      in_record_ = false;
      ++record_;
    } else if (property_ != element.corners) {
      pass_property(element.properties[property_++]);
    } else {
      const std::size_t before = batch.triangle_count();
      if (advance_corners(element, batch)) ++property_;
      of_record_ += batch.triangle_count() - before;
    }
  }

  // Returns true at the end of the list.
  bool advance_corners(const PlyElement& element, MeshBatch& batch) {
    const PlyProperty& list = element.properties[element.corners];
    const bool strip = element.role == PlyRole::kStrips;
    if (!std::exchange(in_list_, true)) {
      corners_left_ = list_length(list);
      if (expects_triangles_ && corners_left_ != 3) throw input_changed();
      face_.begin(strip ? FaceShape::kStrip : FaceShape::kPolygon);
    }
    for (; corners_left_ != 0 && room(batch) != 0; --corners_left_) {
      const std::int64_t corner = decoder_.integer(list.type, "vertex index");
      if (strip && corner == -1) {
        end_face(batch);
        face_.begin(FaceShape::kStrip);
      } else {
        check_corner(corner);
        face_.add(VertexId(static_cast<std::uint64_t>(corner)), batch);
      }
    }
    if (corners_left_ != 0 || room(batch) == 0) return false;
    end_face(batch);
    return true;
  }

  // Triangles alone keep the order of the file: that of a batch goes by dimension, and batches are of any size.
  void end_face(MeshBatch& batch) {
    face_.end(batch);
    if (!triangles_only_ || (batch.points().empty() && batch.edges().empty())) return;
    turned_[0] += batch.points().size();
    turned_[1] += batch.edges().size() / 2;
    const auto turn = [&batch](std::vector<VertexId>& face) {
      if (!face.empty()) batch.triangles().insert(batch.triangles().end(), {face.front(), face.back(), face.back()});
      face.clear();
    };
    turn(batch.points());
    turn(batch.edges());
  }

  void check_corner(std::int64_t corner) const {
    if (corner >= 0 && static_cast<std::uint64_t>(corner) < vertex_limit_) [[likely]]
      return;
    decoder_.fail("a face names vertex " + std::to_string(corner) + ", but the mesh has only " +
                      count_of(vertex_limit_, "vertex"),
                  "vertices are numbered from 0; the file may be damaged here");
  }

  // Whether the element is only a list of corners; in binary, the usual one: a byte for the length, then 32-bit
  // corners.
  static bool is_plain(const PlyElement& element) {
    if (element.role != PlyRole::kFaces || element.properties.size() != 1) return false;
    const PlyProperty& list = element.properties.front();
    return !Decoder::kBinary || (byte_size(*list.list_count) == 1 && byte_size(list.type) == 4);
  }

  // Reads consecutive triangles, at most kRunRecords. Returns false if the next record is not a complete, valid
  // triangle: advance_face() then finds out why.
  bool read_triangle_run(const PlyElement& element, MeshBatch& batch) {
    const auto left = static_cast<std::size_t>(std::min<std::uint64_t>(element.count - record_, room(batch)));
    const std::uint64_t limit = std::min(vertex_limit_, 1 + largest_value(element.properties.front().type));
    const std::size_t count = read_triangles(std::min(left, kRunRecords), limit);
    batch.triangles().insert(batch.triangles().end(), run_.begin(),
                             run_.begin() + static_cast<std::ptrdiff_t>(3 * count));
    record_ += count;
    return count != 0;
  }

  // Reads at most `most` triangles with corners below `limit` to the start of run_. Returns their number.
  std::size_t read_triangles(std::size_t most, std::uint64_t limit) {
    if constexpr (Decoder::kBinary) {
      static constexpr std::size_t kRecordBytes = 13;
      Cursor& bytes = decoder_.bytes();
      if (!bytes.ensure(kRecordBytes)) return 0;
      most = std::min(most, bytes.available() / kRecordBytes);
      const std::size_t count = decoder_.swaps() ? copy_triangles<true>(bytes.data(), most, limit, run_.data())
                                                 : copy_triangles<false>(bytes.data(), most, limit, run_.data());
      bytes.advance(count * kRecordBytes);
      return count;
    } else {
      std::array<std::uint64_t, 3> corners;
      std::size_t count = 0;
      for (; count != most && decoder_.plain_triangle(limit, corners); ++count)
        for (std::size_t k = 0; k < 3; ++k) run_[3 * count + k] = VertexId(corners[k]);
      return count;
    }
  }

  // Copies triangles up to the first face that is not a triangle or has a corner not below `limit`. Returns their
  // number.
  template <bool kSwap>
  static std::size_t copy_triangles(const char* record, std::size_t most, std::uint64_t limit, VertexId* out) {
    for (std::size_t i = 0; i < most; ++i, record += 13, out += 3) {
      const std::uint64_t a = load_scalar<std::uint32_t>(record + 1, kSwap);
      const std::uint64_t b = load_scalar<std::uint32_t>(record + 5, kSwap);
      const std::uint64_t c = load_scalar<std::uint32_t>(record + 9, kSwap);
      if (record[0] != 3 || std::max({a, b, c}) >= limit) [[unlikely]]
        return i;
      out[0] = VertexId(a);
      out[1] = VertexId(b);
      out[2] = VertexId(c);
    }
    return most;
  }

  // Few enough for the output of one call to stay in the first-level cache.
  static constexpr std::size_t kRunRecords = 512;

  PlyHeader header_;
  std::vector<Step> steps_;
  Decoder decoder_;
  std::uint64_t vertex_limit_;

  std::vector<std::size_t> column_of_;                       // of each vertex property
  std::vector<bool> carried_;                                // of each column: it may have any values
  std::vector<std::vector<double>*> columns_;                // coordinates, then properties, of the batch
  std::vector<std::pair<std::size_t, std::size_t>> copies_;  // columns that were requested twice: to, from
  std::vector<double> scratch_;
  // A buffer for triangles: growing the batch instead would fill the new room with zeros first.
  std::array<VertexId, 3 * kRunRecords> run_;

  std::size_t step_ = 0;
  std::uint64_t record_ = 0;  // of the element of the step
  bool in_record_ = false, in_list_ = false;
  std::size_t property_ = 0;
  std::uint64_t corners_left_ = 0;
  // Of the record that is being read: where it begins, and its triangles so far.
  std::uint64_t record_begin_ = 0;
  std::size_t of_record_ = 0;
  SimplexAssembler face_;
  std::uint64_t non_finite_values_ = 0;
  bool trailing_ = false;
  bool triangles_only_ = false, expects_triangles_ = false;
  std::array<std::uint64_t, 2> turned_{};  // points and edges that became triangles
};

}  // namespace

std::unique_ptr<MeshReader> open_ply(std::unique_ptr<ContentSource> source, const ReadOptions& options) {
  TextCursor text(std::move(source));
  PlyHeader header = read_ply_header(text);
  if (header.encoding == PlyEncoding::kAscii)
    return std::make_unique<PlyReader<AsciiPlyDecoder>>(std::move(text), std::move(header), options);
  return std::make_unique<PlyReader<BinaryPlyDecoder>>(std::move(text), std::move(header), options);
}

std::unique_ptr<PlyBodyReader> open_ply_faces(std::unique_ptr<ContentSource> source, const PlyHeader& header) {
  auto reader = std::make_unique<PlyReader<BinaryPlyDecoder>>(TextCursor(std::move(source)), header, ReadOptions{});
  reader->deliver_triangles_only();
  reader->move_to_faces();
  return reader;
}

}  // namespace reeb::io
