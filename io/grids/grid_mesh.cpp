#include "io/grids/grid_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/grid/grid_division.h"

namespace reeb::io {
namespace {

std::string component_name(unsigned component) {
  return component == 0 ? "value" : "value:" + std::to_string(component);
}

// Whether the axis that varies fastest may be the channels of a colour image. Volumes are seldom that thin.
bool looks_like_channels(const std::array<std::uint64_t, 3>& size) {
  return (size[0] == 3 || size[0] == 4) && size[1] > 8 && size[2] > 8;
}

// A grid in which the axes of one vertex are left out, and slices are along the last of the others: of an image of two
// axes, a slice is a row.
class Slices {
 public:
  explicit Slices(const std::array<std::uint64_t, 3>& size) {
    std::vector<std::uint64_t> sizes;
    for (const std::uint64_t n : size)
      if (n > 1) sizes.push_back(n);
    if (sizes.empty()) return;
    size_[2] = sizes.back();
    sizes.pop_back();
    for (std::size_t k = 0; k < sizes.size(); ++k) size_[k] = sizes[k];
  }
  std::uint64_t count() const { return size_[2]; }
  std::uint64_t vertices() const { return size_[0] * size_[1]; }  // of a slice
  std::uint8_t axes() const {
    unsigned set = 0;
    for (std::size_t k = 0; k < 3; ++k) set |= static_cast<unsigned>(size_[k] > 1) << k;
    return static_cast<std::uint8_t>(set);
  }
  // Whether a vertex of a slice stays in it, one step up along the first two of these axes, or down.
  bool has_up(std::uint64_t v, unsigned axes) const {
    return ((axes & 1) == 0 || v % size_[0] + 1 < size_[0]) && ((axes & 2) == 0 || v / size_[0] + 1 < size_[1]);
  }
  bool has_down(std::uint64_t v, unsigned axes) const {
    return ((axes & 1) == 0 || v % size_[0] != 0) && ((axes & 2) == 0 || v >= size_[0]);
  }
  // The distance of such a step within the slice.
  std::uint64_t step(unsigned axes) const { return (axes & 1) + ((axes & 2) != 0 ? size_[0] : 0); }

 private:
  std::array<std::uint64_t, 3> size_{1, 1, 1};
};

constexpr unsigned kNextSlice = 4;  // the set of the axis across slices

class GridMesh : public MeshReader {
 public:
  GridMesh(std::unique_ptr<GridReader> grid, ReadOptions options, const GridMeshOptions& grid_options)
      : grid_(std::move(grid)),
        options_(std::move(options)),
        skips_(grid_options.skip_nodata),
        renumbers_(grid_options.renumber),
        slices_(grid_->info().size) {
    options_.batch_events = std::max<std::size_t>(options_.batch_events, 1);
    describe();
    choose_columns();
    choose_simplices();
  }

  const MeshInfo& info() const override { return info_; }
  std::uint64_t bytes_read() const override { return grid_->bytes_read(); }
  std::uint64_t memory_bytes() const override {
    std::uint64_t bytes = grid_->memory_bytes() + values_.capacity() * sizeof(double);
    for (const auto& slice : numbers_) bytes += slice.capacity() * sizeof(std::uint64_t);
    return bytes;
  }
  std::vector<std::string> warnings() const override;
  // After renumbering, numbers are no grid indices, so boxes cannot be used.
  bool leave_out_simplices() override {
    if (renumbers_) return false;
    vertices_only_ = true;
    return true;
  }

  // Vertices of slice k + 1, then the simplices whose lowest vertex is in slice k, then the finalization of slice k.
  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.coordinates.resize(info_.dimension);
    batch.properties.resize(columns_.size());
    batch.first_vertex = VertexId(next_number_);
    while (room(batch) != 0 && stage_ != Stage::kEnd && step(batch)) continue;
    return !batch.empty();
  }

 private:
  enum class Stage { kVertices, kSimplices, kFinal, kEnd };
  static constexpr std::uint64_t kSkipped = ~std::uint64_t{0};

  void describe();
  void choose_columns();
  void choose_simplices();
  std::size_t room(const MeshBatch& batch) const {
    const std::size_t used = batch.vertex_count + batch.simplex_count<3>() + batch.finalized.size();
    return options_.batch_events - std::min(options_.batch_events, used);
  }
  bool step(MeshBatch& batch);
  bool add_vertices(MeshBatch& batch);
  bool read_values();
  void advance(std::size_t vertices);
  std::span<std::uint64_t> next_numbers(std::size_t count);
  std::uint64_t slice_of_vertex() const { return vertex_ / slices_.vertices(); }
  bool is_skipped(std::size_t at) const;
  void add_columns(MeshBatch& batch, std::size_t count);
  void note_non_finite_values(std::span<const double> values);
  void end_vertices();
  void add_simplices(MeshBatch& batch);
  bool is_present(const GridSimplex& simplex) const;
  bool has_coface(const std::vector<GridStep>& steps) const;
  std::uint64_t number(unsigned axes) const;
  void append(const GridSimplex& simplex, MeshBatch& batch) const;
  void add_finalizations(MeshBatch& batch);

  std::unique_ptr<GridReader> grid_;
  ReadOptions options_;
  bool skips_, renumbers_, vertices_only_ = false;
  Slices slices_;
  MeshInfo info_;
  std::vector<unsigned> columns_;  // the components that are properties
  std::vector<GridSimplex> simplices_;
  std::vector<std::vector<GridStep>> cofaces_;  // of each of them, if vertices are skipped

  Stage stage_ = Stage::kVertices;
  std::vector<double> values_;        // that were read and not delivered yet
  std::size_t taken_ = 0, read_ = 0;  // vertices of them
  std::uint64_t vertex_ = 0;          // index of the next one in the grid
  std::uint64_t next_number_ = 0;
  std::uint64_t slice_ = 0;       // whose simplices come next
  std::uint64_t in_slice_ = 0;    // the next vertex of the slice whose vertices, simplices or finalizations come
  std::size_t next_simplex_ = 0;  // at that vertex
  // If vertices are skipped: the numbers of those of a slice, or kSkipped; slice k is numbers_[k % 3].
  std::array<std::vector<std::uint64_t>, 3> numbers_;
  std::uint64_t nodata_values_ = 0, skipped_ = 0, non_finite_values_ = 0;
};

void GridMesh::describe() {
  const GridInfo& grid = grid_->info();
  info_.format = grid.format;
  info_.dimension = grid.axes;
  for (unsigned c = 0; c < grid.components; ++c) info_.property_names.push_back(component_name(c));
  if (!skips_) info_.vertex_count = grid.vertex_count();
  if (skips_ && !renumbers_) info_.number_count = grid.vertex_count();
  info_.finalizes = true;
  info_.file_bytes = grid.file_bytes;
  info_.grid = grid;
}

void GridMesh::choose_columns() {
  if (options_.all_properties) options_.properties = info_.property_names;
  if (options_.properties.empty() && options_.value_of_image) options_.properties = {component_name(0)};
  for (const std::string& name : options_.properties) {
    const auto found = std::ranges::find(info_.property_names, name == "value:0" ? component_name(0) : name);
    if (found == info_.property_names.end())
      throw Error(ErrorKind::kBadInput, "the image has no \"" + name + "\"",
                  "its vertices have " + count_of(info_.property_names.size(), "value"));
    columns_.push_back(static_cast<unsigned>(found - info_.property_names.begin()));
  }
}

void GridMesh::choose_simplices() {
  const std::uint8_t axes = slices_.axes();
  std::size_t corners = 1;
  for (unsigned set = axes; set != 0; set &= set - 1) ++corners;
  simplices_ = grid_simplices(axes, skips_ ? 2 : std::max<std::size_t>(corners, 2));
  if (!skips_) return;
  for (const GridSimplex& simplex : simplices_) cofaces_.push_back(steps_to_cofaces(simplex, axes));
}

std::vector<std::string> GridMesh::warnings() const {
  std::vector<std::string> lines = grid_->warnings();
  const auto add = [&](std::uint64_t count, const char* noun, const std::string& what) {
    if (count != 0) lines.push_back(count_of(count, noun) + what);
  };
  add(skipped_, "vertex", " without data " + std::string(skipped_ == 1 ? "was" : "were") + " skipped");
  add(nodata_values_, "vertex",
      std::string(nodata_values_ == 1 ? " has" : " have") +
          " the value that stands for no data; it counts as a number without --nodata skip");
  const GridInfo& grid = *info_.grid;
  if (grid.components > 1 && columns_ == std::vector<unsigned>{0})
    lines.push_back("each vertex has " + count_of(grid.components, "value") +
                    "; value is the first, value:1 the second");
  if (grid.components == 1 && !columns_.empty() && looks_like_channels(grid.size))
    lines.push_back("an axis is " + std::to_string(grid.size[0]) +
                    " long; if this is a colour image, use one of its channels");
  add(non_finite_values_, "value",
      " of the image " + std::string(non_finite_values_ == 1 ? "is" : "are") + " not finite");
  return lines;
}

// Adds events of the present stage. False if the batch must end first: its vertices come first, its finalizations last.
bool GridMesh::step(MeshBatch& batch) {
  const bool has_simplices = batch.simplex_count<3>() != 0;
  switch (stage_) {
    case Stage::kVertices:
      if (has_simplices || !batch.finalized.empty()) return false;
      return add_vertices(batch);
    case Stage::kSimplices:
      if (!batch.finalized.empty()) return false;
      add_simplices(batch);
      return true;
    case Stage::kFinal:
      add_finalizations(batch);
      return true;
    case Stage::kEnd:
      break;
  }
  return false;
}

// A run of vertices of which none is skipped, or one that is.
bool GridMesh::add_vertices(MeshBatch& batch) {
  if (!vertices_only_ && in_slice_ == slices_.vertices()) {
    end_vertices();
    return true;
  }
  if (taken_ == read_ && !read_values()) {
    stage_ = Stage::kEnd;
    return true;
  }
  if (skips_ && is_skipped(taken_)) {
    if (batch.vertex_count != 0 && !renumbers_) return false;
    if (!vertices_only_) next_numbers(1)[0] = kSkipped;
    ++skipped_;
    advance(1);
    if (!renumbers_) next_number_ = vertex_;
    if (batch.vertex_count == 0) batch.first_vertex = VertexId(next_number_);
    return true;
  }
  std::uint64_t most = std::min<std::uint64_t>(room(batch), read_ - taken_);
  if (!vertices_only_) most = std::min(most, slices_.vertices() - in_slice_);
  std::size_t count = 1;
  while (count < most && !(skips_ && is_skipped(taken_ + count))) ++count;
  if (skips_ && !vertices_only_) {
    const std::span<std::uint64_t> numbers = next_numbers(count);
    std::iota(numbers.begin(), numbers.end(), next_number_);
  }
  add_columns(batch, count);
  batch.vertex_count += count;
  next_number_ += count;
  advance(count);
  return true;
}

bool GridMesh::read_values() {
  constexpr std::size_t kVerticesAtOnce = 8192, kValuesAtOnce = 65536;
  const std::size_t components = grid_->info().components;
  values_.resize(std::clamp<std::size_t>(kValuesAtOnce / components, 1, kVerticesAtOnce) * components);
  taken_ = 0;
  read_ = grid_->read(values_);
  return read_ != 0;
}

void GridMesh::advance(std::size_t vertices) {
  taken_ += vertices;
  vertex_ += vertices;
  in_slice_ += vertices;
}

// Of the next vertices. The slice grows as values arrive, since a header can announce a slice of any size.
std::span<std::uint64_t> GridMesh::next_numbers(std::size_t count) {
  std::vector<std::uint64_t>& slice = numbers_[slice_of_vertex() % 3];
  const std::uint64_t end = in_slice_ + count;
  if (slice.capacity() < end)
    slice.reserve(std::min(std::max<std::uint64_t>(2 * slice.capacity(), end), slices_.vertices()));
  if (slice.size() < end) slice.resize(end);
  return std::span(slice).subspan(in_slice_, count);
}

bool GridMesh::is_skipped(std::size_t at) const {
  const GridInfo& grid = grid_->info();
  const auto values = std::span(values_).subspan(at * grid.components, grid.components);
  return std::ranges::any_of(values,
                             [&](double value) { return std::isnan(value) || (grid.nodata && value == *grid.nodata); });
}

void GridMesh::add_columns(MeshBatch& batch, std::size_t count) {
  const GridInfo& grid = grid_->info();
  std::array<std::uint64_t, 3> at{vertex_ % grid.size[0], vertex_ / grid.size[0] % grid.size[1],
                                  vertex_ / grid.size[0] / grid.size[1]};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < info_.dimension; ++k) batch.coordinates[k].push_back(grid.coordinate(k, at));
    if (++at[0] < grid.size[0]) continue;
    at[0] = 0;
    if (++at[1] < grid.size[1]) continue;
    at[1] = 0;
    ++at[2];
  }
  const auto values = std::span(values_).subspan(taken_ * grid.components, count * grid.components);
  for (std::size_t c = 0; c < columns_.size(); ++c)
    for (std::size_t i = 0; i < count; ++i) batch.properties[c].push_back(values[i * grid.components + columns_[c]]);
  if (grid.nodata)
    for (std::size_t i = 0; i < count; ++i) {
      const auto of_vertex = values.subspan(i * grid.components, grid.components);
      nodata_values_ += std::ranges::find(of_vertex, *grid.nodata) != of_vertex.end();
    }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) note_non_finite_values(values);
}

// A value that is used must be finite.
void GridMesh::note_non_finite_values(std::span<const double> values) {
  const unsigned components = grid_->info().components;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    ++non_finite_values_;
    const auto component = static_cast<unsigned>(i % components);
    if (options_.all_properties || std::ranges::find(columns_, component) == columns_.end()) continue;
    const std::uint64_t vertex = vertex_ + i / components;
    const GridPlace place = grid_->place_of(vertex);
    throw Error(ErrorKind::kBadInput,
                component_name(component) + " of vertex " + std::to_string(vertex) + " is not finite",
                std::isnan(values[i]) ? "leave out vertices without data with --nodata skip, or choose another function"
                                      : "fix this value, or choose another function")
        .at(place.file, place.position);
  }
}

// The first slice has no simplices before the second one is there.
void GridMesh::end_vertices() {
  const std::uint64_t slice = slice_of_vertex() - 1;
  in_slice_ = 0;
  if (slice == 0 && slices_.count() > 1) return;
  slice_ = slice == 0 ? 0 : slice - 1;
  next_simplex_ = 0;
  stage_ = Stage::kSimplices;
}

void GridMesh::add_simplices(MeshBatch& batch) {
  std::size_t left = room(batch);
  for (; in_slice_ < slices_.vertices(); ++in_slice_, next_simplex_ = 0)
    for (; next_simplex_ < simplices_.size(); ++next_simplex_) {
      if (left == 0) return;
      if (!is_present(simplices_[next_simplex_]) || (skips_ && has_coface(cofaces_[next_simplex_]))) continue;
      append(simplices_[next_simplex_], batch);
      --left;
    }
  in_slice_ = 0;
  stage_ = Stage::kFinal;
}

bool GridMesh::is_present(const GridSimplex& simplex) const {
  const unsigned top = simplex.top();
  if (!slices_.has_up(in_slice_, top) || ((top & kNextSlice) != 0 && slice_ + 1 == slices_.count())) return false;
  if (!skips_) return true;
  for (std::size_t c = 0; c < simplex.corner_count; ++c)
    if (number(simplex.corners[c]) == kSkipped) return false;
  return true;
}

bool GridMesh::has_coface(const std::vector<GridStep>& steps) const {
  return std::ranges::any_of(steps, [this](const GridStep& step) {
    if (!slices_.has_up(in_slice_, step.up) || !slices_.has_down(in_slice_, step.down)) return false;
    if ((step.up & kNextSlice) != 0 && slice_ + 1 == slices_.count()) return false;
    if ((step.down & kNextSlice) != 0 && slice_ == 0) return false;
    const std::uint64_t slice =
        slice_ + ((step.up & kNextSlice) != 0 ? 1 : 0) - ((step.down & kNextSlice) != 0 ? 1 : 0);
    return numbers_[slice % 3][in_slice_ + slices_.step(step.up) - slices_.step(step.down)] != kSkipped;
  });
}

// Of the vertex a step up along these axes from the present one.
std::uint64_t GridMesh::number(unsigned axes) const {
  const std::uint64_t slice = slice_ + ((axes & kNextSlice) != 0 ? 1 : 0), v = in_slice_ + slices_.step(axes);
  return skips_ ? numbers_[slice % 3][v] : slice * slices_.vertices() + v;
}

void GridMesh::append(const GridSimplex& simplex, MeshBatch& batch) const {
  auto& corners = batch.simplices[simplex.corner_count - 1u];
  for (std::size_t c = 0; c < simplex.corner_count; ++c) corners.emplace_back(number(simplex.corners[c]));
}

void GridMesh::add_finalizations(MeshBatch& batch) {
  for (std::size_t left = room(batch); in_slice_ < slices_.vertices(); ++in_slice_) {
    const std::uint64_t v = number(0);
    if (v == kSkipped) continue;
    if (left-- == 0) return;
    batch.finalized.emplace_back(v);
  }
  in_slice_ = 0;
  next_simplex_ = 0;
  const std::uint64_t ahead = slices_.count() - slice_;  // slices from this one on
  stage_ = ahead == 1 ? Stage::kEnd : ahead == 2 ? Stage::kSimplices : Stage::kVertices;
  if (ahead == 2) ++slice_;
}

}  // namespace

std::unique_ptr<MeshReader> make_grid_mesh(std::unique_ptr<GridReader> grid, ReadOptions options,
                                           const GridMeshOptions& grid_options) {
  return std::make_unique<GridMesh>(std::move(grid), std::move(options), grid_options);
}

}  // namespace reeb::io
