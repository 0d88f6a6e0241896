#include "io/functions/function_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "io/functions/mesh_field.h"
#include "io/functions/value_file.h"
#include "io/mesh/missing_property.h"
#include "io/mesh/scalar_bytes.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/hash.h"

namespace reeb::io {
namespace {

// Where squares underflow or overflow, the differences are scaled: by powers of two, which does not round them.
constexpr double kLeastDistance = 1e-145, kMostDistance = std::numeric_limits<double>::max();
constexpr double kDistanceScale = 0x1p600;

}  // namespace

double random_value(std::uint64_t seed, std::uint64_t vertex) noexcept {
  return static_cast<double>(mix(mix(seed) + vertex) >> 11) * 0x1p-53;
}

FunctionSource::FunctionSource(const FunctionSpec& spec, const MeshInfo& info, std::span<const std::string> properties,
                               std::string mesh_name, const MeshField* field)
    : spec_(spec), mesh_name_(std::move(mesh_name)), number_count_(info.number_count) {
  using Kind = FunctionSpec::Kind;
  if (spec.kind == Kind::kCoordinate) {
    if (spec.number >= info.dimension)
      throw Error(ErrorKind::kBadInput,
                  "the mesh has no coordinate " + spec.text + "; its vertices have " + std::to_string(info.dimension),
                  "choose one of c0 to c" + std::to_string(info.dimension - 1))
          .at(mesh_name_);
    columns_ = {static_cast<unsigned>(spec.number)};
  } else if (spec.kind == Kind::kValue && !info.grid) {
    throw Error(ErrorKind::kBadInput, "the mesh is not an image, so it has no " + spec.text,
                spec.text + " is the function of an image; " + mesh_name_ +
                    " is a mesh: choose a coordinate, property:NAME or file:PATH")
        .at(mesh_name_);
  } else if (spec.kind == Kind::kProperty || spec.kind == Kind::kValue) {
    const auto found = std::ranges::find(properties, spec.argument);
    if (found == properties.end()) throw missing_property(spec.argument, info.property_names).at(mesh_name_);
    columns_ = {info.dimension + static_cast<unsigned>(found - properties.begin())};
  } else if (spec.kind == Kind::kFile) {
    file_ = open_values(spec.argument, number_count_ ? number_count_ : info.vertex_count, number_count_.has_value());
  } else if (spec.needs_field()) {
    file_ = raw_values(field->values);
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
    if (number_count_ && !values.empty()) file_->skip_to(first);
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
  const auto scaled_distance = [&](std::size_t i, double scale) {
    double sum = 0;
    for (std::size_t k = 0; k < center_.size(); ++k) {
      const double difference = (column(k)[i] - center_[k]) * scale;
      sum += difference * difference;
    }
    return std::sqrt(sum) / scale;
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < kLeastDistance) [[unlikely]]
      values[i] = scaled_distance(i, kDistanceScale);
    else if (values[i] > kMostDistance) [[unlikely]]
      values[i] = scaled_distance(i, 1 / kDistanceScale);
  }
}

void FunctionSource::look_up(IndexedMesh& mesh) {
  if (!needs_lookup()) return;
  VertexId vertex(spec_.number);
  mesh.from_original({&vertex, 1});
  if (vertex == VertexId::none()) fail_no_vertex(mesh.vertex_count());
  center_.resize(columns_.size());
  mesh.gather({&vertex, 1}, columns_, center_);
}

void FunctionSource::look_up(MeshReader& reader) {
  std::uint64_t vertices = 0;
  for (MeshBatch batch; center_.empty() && needs_lookup();) {
    if (!reader.read(batch)) fail_no_vertex(vertices);
    vertices += batch.vertex_count;
    const std::uint64_t first = batch.first_vertex.value();
    if (batch.vertex_count != 0 && spec_.number < first) fail_no_vertex(vertices);
    if (spec_.number < first || spec_.number - first >= batch.vertex_count) continue;
    const auto at = static_cast<std::size_t>(spec_.number - first);
    for (const auto& coordinate : batch.coordinates) center_.push_back(coordinate[at] + 0.0);
  }
}

void FunctionSource::fail_no_vertex(std::uint64_t vertex_count) const {
  if (number_count_ && spec_.number < *number_count_)
    throw Error(ErrorKind::kBadInput, spec_.text + " names a vertex without data, which is skipped",
                "name a vertex that has data")
        .at(mesh_name_);
  throw Error(ErrorKind::kBadInput,
              spec_.text + " names a vertex that does not exist: the mesh has " + count_of(vertex_count, "vertex"),
              "vertices are numbered from 0")
      .at(mesh_name_);
}

void FunctionSource::check_count(std::uint64_t vertex_count) {
  if (file_) file_->check_count(value_count(vertex_count));
}

void FunctionSource::check_unchanged() const {
  if (file_) file_->check_unchanged();
}

std::uint64_t FunctionSource::lookup_bytes(std::uint64_t vertex_count) const {
  return file_ ? file_->lookup_bytes(value_count(vertex_count)) : 0;
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
  const auto non_finite = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  const auto index = static_cast<std::size_t>(non_finite - values.begin());
  const std::uint64_t vertex = ids.empty() ? first + index : ids[index].value();
  throw Error(ErrorKind::kBadInput, spec_.text + " of vertex " + std::to_string(vertex) + " is not finite",
              "fix this vertex, or choose another function")
      .at(mesh_name_);
}

}  // namespace reeb::io
