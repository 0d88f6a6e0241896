#include "tools/program/mesh_info.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "io/file/content_source.h"
#include "io/formats/format_detection.h"
#include "io/formats/format_names.h"
#include "io/formats/open_mesh.h"
#include "io/images/image_format.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/printable.h"
#include "libreeb/base/value_range.h"
#include "ooc/chunks/last_use.h"
#include "ooc/chunks/spooled_mesh.h"
#include "ooc/tables/paged_union_find.h"
#include "ooc/whole_mesh/workspace.h"
#include "tools/program/progress.h"
#include "tools/program/simplex_text.h"

namespace reeb::tools {
namespace {

// The components of a mesh, and which vertices are used.
class Connection {
 public:
  explicit Connection(ooc::Workspace& space)
      : sets_("components", space.temp, space.budget, space.share()),
        used_flags_("components", space.temp, space.budget, space.share(), 0) {}

  void add_vertices(std::uint64_t count) { vertices_ += count; }
  void join(VertexId a, VertexId b) { sets_.unite(a.value(), b.value()); }
  void use(VertexId v) {
    std::uint8_t& flag = used_flags_.change(v.value());
    used_ += flag == 0;
    flag = 1;
  }
  std::uint64_t components() const { return vertices_ - sets_.unions(); }
  std::uint64_t used() const { return used_; }

 private:
  ooc::PagedUnionFind sets_;
  ooc::PagedTable<std::uint8_t> used_flags_;
  std::uint64_t vertices_ = 0, used_ = 0;
};

// Opens streams for reading event by event, so that their front is measured exactly.
std::unique_ptr<MeshReader> open(const io::Input& input, const std::string& format, io::ImageOptions image) {
  auto source = input.open();
  ReadOptions options;
  if (!image.is_raw() && !io::image_format_named(format)) {
    const auto kind = format.empty() ? io::detect_format(*source, input.path()) : io::chosen_format(format, *source);
    if (kind == io::MeshFormat::kStreaming) options.batch_events = 1;
  }
  image.renumber = true;
  return io::open_mesh(input, std::move(source), options, image, format);
}

std::uint64_t distinct(std::span<const VertexId> corners) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    count += std::find(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(i), corners[i]) ==
             corners.begin() + static_cast<std::ptrdiff_t>(i);
  return count;
}

class MeshSurvey {
 public:
  MeshSurvey(const io::Input& input, const std::string& format, ooc::Workspace& space, const io::ImageOptions& image)
      : path_(input.path()), space_(space), reader_(open(input, format, image)), connection_(space) {
    bounds_.resize(reader_->info().dimension);
  }

  void run() {
    const bool measures = reader_->info().finalizes;
    std::unique_ptr<IndexedMesh> mesh;
    if (!measures) mesh = reader_->indexed();
    std::unique_ptr<ooc::SpooledMesh> spooled;
    if (!measures && mesh == nullptr)
      spooled =
          std::make_unique<ooc::SpooledMesh>(reader_->info().dimension, space_.temp, space_.budget, 2 * space_.share());
    for (MeshBatch batch; reader_->read(batch);) {
      add(batch);
      bar_.update({"reading", measures ? 0u : 1u}, reader_->bytes_read(), reader_->info().file_bytes,
                  std::accumulate(simplices_.begin(), simplices_.end(), std::uint64_t{0}));
      if (spooled) spooled->append(batch);
    }
    if (spooled) mesh = std::move(spooled);
    if (mesh) predict_front(*mesh);
    bar_.clear();
  }

  void print_text() const;
  void print_json() const;

 private:
  void add(const MeshBatch& batch);
  void add_simplex(std::span<const VertexId> corners);
  void predict_front(IndexedMesh& mesh);

  const std::string& path_;
  ooc::Workspace& space_;
  std::unique_ptr<MeshReader> reader_;
  Connection connection_;
  std::vector<ValueRange> bounds_;
  SimplexCounts simplices_{};
  std::uint64_t vertices_ = 0, degenerate_ = 0, finalized_ = 0;
  std::uint64_t front_ = 0;
  ProgressBar bar_{false};
};

void MeshSurvey::add(const MeshBatch& batch) {
  vertices_ += batch.vertex_count;
  connection_.add_vertices(batch.vertex_count);
  for (std::size_t k = 0; k < bounds_.size(); ++k)
    for (const double value : batch.coordinates[k]) bounds_[k].add(value);
  batch.add_counts(simplices_);
  batch.for_each_simplex([this](std::span<const VertexId> corners) { add_simplex(corners); });
  if (reader_->info().finalizes) front_ = std::max(front_, vertices_ - finalized_);
  finalized_ += batch.finalized.size();
}

void MeshSurvey::add_simplex(std::span<const VertexId> corners) {
  degenerate_ += distinct(corners) < corners.size();
  for (const VertexId v : corners) connection_.use(v);
  for (const VertexId v : corners.subspan(1)) connection_.join(corners[0], v);
}

void MeshSurvey::predict_front(IndexedMesh& mesh) {
  ooc::LastUseOptions options;
  options.allowance_bytes = space_.share();
  // Blocks of one triangle give the exact front; for large meshes, blocks are doubled.
  options.block_triangles = 1;
  options.most_blocks = 1u << 16;
  options.progress = [&](std::uint64_t bytes) { bar_.update({"front"}, bytes, mesh.bytes_total()); };
  front_ = ooc::scan_last_use(mesh, space_.temp, space_.budget, options)->summary().max_live_vertices;
}

void MeshSurvey::print_text() const {
  const MeshInfo& info = reader_->info();
  const std::uint64_t unused = vertices_ - connection_.used();
  fmt::print("{}: {}\n", printable(path_), printable(info.format));
  fmt::print("  vertices      {}, {}\n", with_commas(vertices_),
             unused == 0 ? "all used" : with_commas(unused) + " in no triangle");
  for (std::size_t k = simplices_.size(); k-- > 0;)
    if (simplices_[k] != 0 || k == 2)
      fmt::print("  {:<13} {}\n", simplices_of_dimension(k), with_commas(simplices_[k]));
  if (degenerate_ != 0) fmt::print("  degenerate    {}\n", with_commas(degenerate_));
  fmt::print("  components    {}\n", with_commas(connection_.components()));
  fmt::print("  coordinates   {}\n", info.dimension);
  if (vertices_ != 0)
    for (std::size_t k = 0; k < bounds_.size(); ++k)
      fmt::print("  {:<13} {:.9g} to {:.9g}\n", k < 3 ? std::string(1, "xyz"[k]) : fmt::format("c{}", k),
                 bounds_[k].min, bounds_[k].max);
  fmt::print("  properties    {}\n",
             info.property_names.empty() ? "none" : fmt::format("{}", fmt::join(info.property_names, ", ")));
  fmt::print("  finalization  {}\n", finalized_ == 0 ? "none" : fmt::format("of {}", count_of(finalized_, "vertex")));
  fmt::print("  live front    {} at once: {}\n", count_of(front_, "vertex"),
             info.finalizes ? "measured" : "what a single pass would hold");
  for (const std::string& warning : reader_->warnings()) fmt::print("  note          {}\n", printable(warning));
}

void MeshSurvey::print_json() const {
  const MeshInfo& info = reader_->info();
  nlohmann::ordered_json bounds = nlohmann::ordered_json::array();
  if (vertices_ != 0)
    for (const ValueRange& b : bounds_) bounds.push_back({{"min", b.min}, {"max", b.max}});
  nlohmann::ordered_json json = {{"schema", "reeb.mesh.v1"},
                                 {"path", path_},
                                 {"format", info.format},
                                 {"bytes", info.file_bytes},
                                 {"vertices", vertices_},
                                 {"triangles", simplices_[2]},
                                 {"tetrahedra", simplices_[3]},
                                 {"simplices", simplices_},
                                 {"degenerate", degenerate_},
                                 {"unreferenced_vertices", vertices_ - connection_.used()},
                                 {"components", connection_.components()},
                                 {"dimension", info.dimension},
                                 {"bounds", bounds},
                                 {"properties", info.property_names},
                                 {"finalization", info.finalizes && finalized_ != 0},
                                 {"finalized_vertices", finalized_},
                                 {"live_front", front_},
                                 {"notes", reader_->warnings()}};
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void print_mesh_info(const std::string& path, const std::string& format, std::uint64_t memory_bytes,
                     const std::string& temp_folder, bool json, const io::ImageOptions& image) {
  ooc::Workspace space(temp_folder, memory_bytes);
  const io::Input input(path);
  const auto survey = input.read([&] {
    auto found = std::make_unique<MeshSurvey>(input, format, space, image);
    found->run();
    return found;
  });
  if (json)
    survey->print_json();
  else
    survey->print_text();
}

}  // namespace reeb::tools
