#include "io/functions/function_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "io/file/content_source.h"
#include "io/file/file.h"
#include "io/file/file_windows.h"
#include "io/file/input_file.h"
#include "io/mesh/scalar_bytes.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/hash.h"

namespace reeb::io {
namespace {

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc{} || parsed.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

// "X,Y,Z", finite numbers.
std::optional<std::array<double, 3>> parse_point(std::string_view text) {
  std::array<double, 3> point{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find(',') : text.size();
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parse_number<double>(text.substr(0, end));
    if (!number.ok || !std::isfinite(number.value)) return std::nullopt;
    point[k] = number.value;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return point;
}

std::optional<FunctionSpec> try_parse(std::string_view text) {
  using Kind = FunctionSpec::Kind;
  const std::string whole(text);
  if (text == "x" || text == "y" || text == "z")
    return FunctionSpec{Kind::kCoordinate, static_cast<std::uint64_t>(text[0] - 'x'), {}, whole};
  if (text == "index") return FunctionSpec{Kind::kIndex, 0, {}, whole};
  if (text.starts_with('c')) {
    const auto coordinate = whole_number(text.substr(1));
    if (coordinate) return FunctionSpec{Kind::kCoordinate, *coordinate, {}, whole};
    return std::nullopt;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos || colon + 1 == text.size()) return std::nullopt;
  const std::string_view name = text.substr(0, colon), argument = text.substr(colon + 1);
  if (name == "property") return FunctionSpec{Kind::kProperty, 0, std::string(argument), whole};
  if (name == "file") return FunctionSpec{Kind::kFile, 0, std::string(argument), whole};
  if (name == "distance") {
    if (const auto vertex = whole_number(argument)) return FunctionSpec{Kind::kDistanceToVertex, *vertex, {}, whole};
    if (const auto point = parse_point(argument)) return FunctionSpec{Kind::kDistanceToPoint, 0, {}, whole, *point};
    return std::nullopt;
  }
  const auto seed = whole_number(argument);
  if (name == "random" && seed) return FunctionSpec{Kind::kRandom, *seed, {}, whole};
  return std::nullopt;
}

}  // namespace

class ValueFile {
 public:
  ValueFile() = default;
  ValueFile(const ValueFile&) = delete;
  ValueFile& operator=(const ValueFile&) = delete;
  virtual ~ValueFile() = default;

  // The values of vertices 0, 1, 2, ... in turn.
  virtual double next() = 0;
  virtual double at(std::uint64_t vertex) = 0;
  virtual void check_count(std::uint64_t vertex_count) = 0;
  virtual void check_unchanged() const = 0;
  // Memory that at() takes, for this number of vertices.
  virtual std::uint64_t lookup_bytes(std::uint64_t) const { return 0; }
};

namespace {

[[noreturn]] void throw_wrong_count(const std::string& path, const std::string& position, std::uint64_t values,
                                    bool or_more, std::uint64_t vertices) {
  throw Error(ErrorKind::kBadInput,
              "has " + count_of(values, "value") + (or_more ? " or more" : "") + ", but the mesh has " +
                  count_of(vertices, "vertex"),
              "the file must have one value per vertex")
      .at(path, position);
}

class RawValueFile final : public ValueFile {
 public:
  explicit RawValueFile(const std::string& path)
      : path_(path), windows_(path, {.window_bits = 14, .window_count = 64, .overlap_bytes = 8}) {
    if (windows_.size() % 8 != 0)
      throw Error(ErrorKind::kBadInput, "its size is not a multiple of 8 bytes",
                  "a .f64 file has 8 bytes per vertex; the file may be cut")
          .at(path, std::to_string(windows_.size() / 8 * 8));
  }
  double next() override { return at(next_++); }
  double at(std::uint64_t vertex) override {
    if (vertex >= windows_.size() / 8)
      throw_wrong_count(path_, std::to_string(windows_.size()), windows_.size() / 8, false, vertex + 1);
    const double value = load_scalar<double>(windows_.at(8 * vertex), false);
    if (std::isfinite(value)) [[likely]]
      return value + 0.0;
    throw Error(ErrorKind::kBadInput, "the value of vertex " + std::to_string(vertex) + " is not finite",
                "give every vertex a finite value")
        .at(path_, std::to_string(8 * vertex));
  }
  void check_unchanged() const override { windows_.file()->check_unchanged("the file"); }
  void check_count(std::uint64_t vertex_count) override {
    if (windows_.size() / 8 != vertex_count)
      throw_wrong_count(path_, std::to_string(8 * std::min(vertex_count, windows_.size() / 8)), windows_.size() / 8,
                        false, vertex_count);
  }

 private:
  std::string path_;
  FileWindows windows_;
  std::uint64_t next_ = 0;
};

class TextValueFile final : public ValueFile {
 public:
  explicit TextValueFile(const std::string& path) : path_(path), input_(path) { open(); }

  double next() override {
    if (!text_->more()) {
      text_->mark();
      throw_wrong_count(path_, text_->position(), read_, false, read_ + 1);
    }
    const auto value = text_->finite_number<double>("value");
    if (text_->more_on_line()) {
      text_->token();
      text_->fail("a line has more than one number", "write one number per line, in the order of vertices");
    }
    ++read_;
    return value;
  }
  double at(std::uint64_t vertex) override {
    if (values_.empty()) {
      if (vertex == read_) return next();
      open();
    }
    while (values_.size() <= vertex) values_.push_back(next());
    return values_[vertex];
  }
  void check_unchanged() const override { input_.check_unchanged("the file"); }
  void check_count(std::uint64_t vertex_count) override {
    if (!values_.empty() || read_ == 0) {
      values_.reserve(vertex_count);
      while (values_.size() < vertex_count) values_.push_back(next());
    }
    const bool more = text_->more();
    text_->mark();
    if (more || read_ != vertex_count)
      throw_wrong_count(path_, text_->position(), read_ + (more ? 1 : 0), more, vertex_count);
  }
  std::uint64_t lookup_bytes(std::uint64_t vertex_count) const override { return vertex_count * sizeof(double); }

 private:
  void open() {
    text_.emplace(input_.open(), TextStyle{.comments = true});
    read_ = 0;
  }

  std::string path_;
  Input input_;
  std::optional<TextCursor> text_;
  std::uint64_t read_ = 0;
  std::vector<double> values_;  // filled if vertices are looked up out of order or counted beforehand
};

// An empty file has the values of a mesh without vertices.
class EmptyValueFile final : public ValueFile {
 public:
  explicit EmptyValueFile(const std::string& path) : path_(path) {}
  double next() override { throw_empty(path_); }
  double at(std::uint64_t) override { throw_empty(path_); }
  void check_count(std::uint64_t vertex_count) override {
    if (vertex_count != 0) throw_empty(path_);
  }
  void check_unchanged() const override {}

 private:
  std::string path_;
};

std::unique_ptr<ValueFile> open_values(const std::string& path, std::optional<std::uint64_t> vertex_count) {
  check_input_file(path);
  if (is_regular_file(path) && File::open_for_reading(path).size() == 0) {
    if (vertex_count && *vertex_count != 0) throw_empty(path);
    return std::make_unique<EmptyValueFile>(path);
  }
  if (!path.ends_with(".f64")) return std::make_unique<TextValueFile>(path);
  auto values = std::make_unique<RawValueFile>(path);
  if (vertex_count) values->check_count(*vertex_count);
  return values;
}

}  // namespace

FunctionSpec parse_function(std::string_view text) {
  if (auto spec = try_parse(text)) return *std::move(spec);
  throw Error(ErrorKind::kUsage, "\"" + std::string(text) + "\" is not a function",
              "functions are x, y, z, cK (a coordinate, from 0), index, random:SEED, property:NAME, file:PATH, "
              "distance:VERTEX and distance:X,Y,Z");
}

FunctionSpec default_function(const MeshInfo& info) {
  return parse_function(info.dimension == 1 ? "x" : info.dimension == 2 ? "y" : "z");
}

std::string file_name_part(const FunctionSpec& spec) {
  std::string name = spec.text;
  std::ranges::replace(name, ':', '-');
  std::ranges::replace(name, '/', '-');
  return name;
}

std::vector<std::string> needed_properties(std::span<const FunctionSpec> specs) {
  std::vector<std::string> names;
  for (const FunctionSpec& spec : specs)
    if (spec.kind == FunctionSpec::Kind::kProperty && std::ranges::find(names, spec.argument) == names.end())
      names.push_back(spec.argument);
  return names;
}

double random_value(std::uint64_t seed, std::uint64_t vertex) noexcept {
  return static_cast<double>(mix(mix(seed) + vertex) >> 11) * 0x1p-53;
}

FunctionSource::FunctionSource(const FunctionSpec& spec, const MeshInfo& info, std::span<const std::string> properties,
                               std::string mesh_name)
    : spec_(spec), mesh_name_(std::move(mesh_name)) {
  using Kind = FunctionSpec::Kind;
  if (spec.kind == Kind::kCoordinate) {
    if (spec.number >= info.dimension)
      throw Error(ErrorKind::kBadInput,
                  "the mesh has no coordinate " + spec.text + "; its vertices have " + std::to_string(info.dimension),
                  "choose one of c0 to c" + std::to_string(info.dimension - 1))
          .at(mesh_name_);
    columns_ = {static_cast<unsigned>(spec.number)};
  } else if (spec.kind == Kind::kProperty) {
    const auto found = std::ranges::find(properties, spec.argument);
    if (found == properties.end())
      throw Error(ErrorKind::kBadInput, "the mesh has no vertex property \"" + spec.argument + "\"",
                  "choose a property that the mesh has, a coordinate, or file:PATH")
          .at(mesh_name_);
    columns_ = {info.dimension + static_cast<unsigned>(found - properties.begin())};
  } else if (spec.kind == Kind::kFile) {
    file_ = open_values(spec.argument, info.vertex_count);
  } else if (is_distance()) {
    columns_.resize(info.dimension);
    std::iota(columns_.begin(), columns_.end(), 0u);
    if (needs_lookup()) return;
    if (info.dimension != 3)
      throw Error(ErrorKind::kBadInput,
                  spec.text + " is a point with three coordinates; the vertices have " + std::to_string(info.dimension),
                  "name a vertex instead: distance:VERTEX")
          .at(mesh_name_);
    center_.assign(spec.point.begin(), spec.point.end());
  }
}

FunctionSource::~FunctionSource() = default;

std::string FunctionSource::source_file() const {
  return spec_.kind == FunctionSpec::Kind::kFile ? spec_.argument : std::string();
}

std::span<const unsigned> FunctionSource::columns() const { return columns_; }

void FunctionSource::evaluate(const MeshBatch& batch, std::span<double> values) {
  const std::uint64_t first = batch.first_vertex.value();
  if (is_distance()) {
    measure_distances([&](std::size_t k) { return std::span<const double>(batch.coordinates[k]); }, values);
    check_finite(values, {}, first);
  } else if (!columns_.empty()) {
    copy_finite(batch.column(columns_[0]), values, {}, first);
  } else if (file_) {
    for (double& value : values) value = file_->next();
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_of(first + i);
  }
}

void FunctionSource::evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> columns,
                              std::span<double> values) {
  if (is_distance()) {
    measure_distances([&](std::size_t k) { return columns[k]; }, values);
    check_finite(values, ids, 0);
  } else if (!columns_.empty()) {
    copy_finite(columns[0], values, ids, 0);
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = value_of(ids[i].value());
  }
}

template <class Column>
void FunctionSource::measure_distances(const Column& column, std::span<double> values) const {
  std::ranges::fill(values, 0.0);
  for (std::size_t k = 0; k < center_.size(); ++k) {
    const std::span<const double> coordinate = column(k);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double difference = coordinate[i] - center_[k];
      values[i] += difference * difference;
    }
  }
  for (double& value : values) value = std::sqrt(value);
}

void FunctionSource::look_up(IndexedMesh& mesh) {
  if (!needs_lookup()) return;
  if (spec_.number >= mesh.vertex_count()) fail_no_vertex(mesh.vertex_count());
  const VertexId vertex(spec_.number);
  center_.resize(columns_.size());
  mesh.gather({&vertex, 1}, columns_, center_);
}

void FunctionSource::look_up(MeshReader& reader) {
  std::uint64_t vertices = 0;
  for (MeshBatch batch; center_.empty() && needs_lookup();) {
    if (!reader.read(batch)) fail_no_vertex(vertices);
    vertices += batch.vertex_count;
    if (spec_.number >= vertices) continue;
    const auto at = static_cast<std::size_t>(spec_.number - batch.first_vertex.value());
    for (const auto& coordinate : batch.coordinates) center_.push_back(coordinate[at] + 0.0);
  }
}

void FunctionSource::fail_no_vertex(std::uint64_t vertex_count) const {
  throw Error(ErrorKind::kBadInput,
              spec_.text + " names a vertex that does not exist: the mesh has " + count_of(vertex_count, "vertex"),
              "vertices are numbered from 0")
      .at(mesh_name_);
}

void FunctionSource::check_count(std::uint64_t vertex_count) {
  if (file_) file_->check_count(vertex_count);
}

void FunctionSource::check_unchanged() const {
  if (file_) file_->check_unchanged();
}

std::uint64_t FunctionSource::lookup_bytes(std::uint64_t vertex_count) const {
  return file_ ? file_->lookup_bytes(vertex_count) : 0;
}

double FunctionSource::value_of(std::uint64_t vertex) {
  if (file_) return file_->at(vertex);
  if (spec_.kind == FunctionSpec::Kind::kRandom) return random_value(spec_.number, vertex);
  return static_cast<double>(vertex);
}

void FunctionSource::copy_finite(std::span<const double> from, std::span<double> to, std::span<const VertexId> ids,
                                 std::uint64_t first) const {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + 0.0;
  check_finite(to, ids, first);
}

void FunctionSource::check_finite(std::span<const double> values, std::span<const VertexId> ids,
                                  std::uint64_t first) const {
  if (all_finite(values)) [[likely]]
    return;
  const auto odd = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  const auto index = static_cast<std::size_t>(odd - values.begin());
  const std::uint64_t vertex = ids.empty() ? first + index : ids[index].value();
  throw Error(ErrorKind::kBadInput, spec_.text + " of vertex " + std::to_string(vertex) + " is not finite",
              "fix this vertex, or choose another function")
      .at(mesh_name_);
}

}  // namespace reeb::io
