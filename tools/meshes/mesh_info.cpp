#include "tools/meshes/mesh_info.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/file/content_source.h"
#include "io/formats/format_detection.h"
#include "io/formats/format_names.h"
#include "io/formats/open_input.h"
#include "io/images/image_format.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/printable.h"
#include "libreeb/base/value_range.h"
#include "ooc/census/mesh_census.h"
#include "ooc/threads/machine_threads.h"
#include "ooc/whole_mesh/workspace.h"
#include "tools/library/run_input.h"
#include "tools/meshes/census_text.h"
#include "tools/program/progress.h"
#include "tools/program/simplex_text.h"

namespace reeb::tools {
namespace {

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

// The lengths of the steps along the axes of the image.
std::vector<double> spacing_of(const GridInfo& grid) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k < grid.axes; ++k) {
    const auto& step = grid.step[k];
    lengths.push_back(std::hypot(step[0], step[1], step[2]));
  }
  return lengths;
}

std::string describe_grid(const GridInfo& grid) {
  const std::vector<double> spacing = spacing_of(grid);
  std::string size, lengths;
  for (std::size_t k = 0; k < spacing.size(); ++k) {
    size += (k == 0 ? "" : " x ") + with_commas(grid.size[k]);
    lengths += fmt::format("{}{:.6g}", k == 0 ? "" : " x ", spacing[k]);
  }
  return fmt::format("{}{}{}, spacing {}{}", size, grid.value_type.empty() ? "" : ", ", grid.value_type, lengths,
                     grid.has_spacing ? "" : " (not in the file)");
}

class MeshSurvey {
 public:
  MeshSurvey(const io::Input& input, const std::string& format, ooc::Workspace& space, const io::ImageOptions& image)
      : path_(input.path()), reader_(open(input, format, image)) {
    bounds_.resize(reader_->info().dimension);
    ProgressBar bar(false);
    ooc::CensusOptions options;
    options.background = size_of(reader_->info()) == ooc::MeshSize::kAny && ooc::machine_threads() > 1;
    options.progress = [&](const ooc::CensusProgress& at) {
      bar.update(pass_of(at.phase), at.done, at.total, at.simplices);
    };
    if (input.can_reopen()) options.read_again = [&] { return open(input, format, image); };
    options.observe = [this](const MeshBatch& batch) { see(batch); };
    if (const std::unique_ptr<IndexedMesh> mesh = reader_->indexed()) {
      see_vertices();
      census_ = ooc::take_census(*mesh, reader_->info().dimension, space, options);
      notes_ = mesh->warnings();
    } else {
      census_ = ooc::take_census(*reader_, space, options);
      notes_ = reader_->warnings();
    }
    bar.clear();
  }

  void print_text() const;
  void print_json() const;

 private:
  void see(const MeshBatch& batch) {
    seen_ += batch.vertex_count;
    finalized_ += batch.finalized.size();
    for (std::size_t k = 0; k < bounds_.size(); ++k)
      for (const double value : batch.coordinates[k]) bounds_[k].add(value);
  }
  // Of a mesh that can be looked up, the reader is needed for its vertices only.
  void see_vertices() {
    for (MeshBatch batch; seen_ != reader_->info().vertex_count && reader_->read(batch);) see(batch);
  }

  const std::string& path_;
  std::unique_ptr<MeshReader> reader_;
  ooc::MeshCensus census_;
  std::vector<ValueRange> bounds_;
  std::uint64_t seen_ = 0, finalized_ = 0;
  std::vector<std::string> notes_;
};

void MeshSurvey::print_text() const {
  const MeshInfo& info = reader_->info();
  const std::uint64_t unused = census_.unused_vertices;
  fmt::print("{}: {}\n", printable(path_), printable(info.format));
  fmt::print("  vertices      {}, {}\n", with_commas(census_.vertices),
             unused == 0 ? "all used" : with_commas(unused) + " in no triangle");
  for (std::size_t k = census_.simplices.size(); k-- > 0;)
    if (census_.simplices[k] != 0 || k == 2)
      fmt::print("  {:<13} {}\n", simplices_of_dimension(k), with_commas(census_.simplices[k]));
  print_census(census_);
  if (info.grid) fmt::print("  grid          {}\n", describe_grid(*info.grid));
  fmt::print("  coordinates   {}\n", info.dimension);
  if (census_.vertices != 0)
    for (std::size_t k = 0; k < bounds_.size(); ++k)
      fmt::print("  {:<13} {:.9g} to {:.9g}\n", k < 3 ? std::string(1, "xyz"[k]) : fmt::format("c{}", k),
                 bounds_[k].min, bounds_[k].max);
  fmt::print("  properties    {}\n",
             info.property_names.empty() ? "none" : printable(fmt::format("{}", fmt::join(info.property_names, ", "))));
  if (!info.grid)
    fmt::print("  finalization  {}\n", finalized_ == 0 ? "none"
                                                       : fmt::format("{} of {}", with_commas(finalized_),
                                                                     count_of(census_.vertices, "vertex")));
  if (census_.live_front)
    fmt::print("  live front    {} at once: {}\n", count_of(*census_.live_front, "vertex"),
               info.finalizes ? "measured" : "what a single pass would hold");
  else
    fmt::print("  live front    not counted: triangles that share a vertex lie too far apart in this order\n");
  for (const std::string& warning : notes_) fmt::print("  note          {}\n", printable(warning));
}

void MeshSurvey::print_json() const {
  const MeshInfo& info = reader_->info();
  nlohmann::ordered_json bounds = nlohmann::ordered_json::array();
  if (census_.vertices != 0)
    for (const ValueRange& b : bounds_) bounds.push_back({{"min", b.min}, {"max", b.max}});
  nlohmann::ordered_json json = {{"schema", "reeb.mesh.v2"},
                                 {"path", path_},
                                 {"format", info.format},
                                 {"bytes", info.file_bytes},
                                 {"vertices", census_.vertices},
                                 {"triangles", census_.simplices[2]},
                                 {"tetrahedra", census_.simplices[3]},
                                 {"simplices", census_.simplices},
                                 {"unreferenced_vertices", census_.unused_vertices},
                                 {"dimension", info.dimension},
                                 {"bounds", bounds},
                                 {"properties", info.property_names},
                                 {"finalization", info.finalizes && finalized_ != 0},
                                 {"finalized_vertices", finalized_}};
  if (info.grid) {
    const auto size = std::span(info.grid->size).first(spacing_of(*info.grid).size());
    json["grid"] = {{"size", std::vector(size.begin(), size.end())},
                    {"type", info.grid->value_type},
                    {"spacing", spacing_of(*info.grid)},
                    {"spacing_in_file", info.grid->has_spacing}};
  }
  json["live_front"] = census_.live_front ? nlohmann::ordered_json(*census_.live_front) : nlohmann::ordered_json();
  add_defects(json, census_);
  add_topology(json, census_);
  json["notes"] = notes_;
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

void print_mesh_info(const std::string& path, const std::string& format, std::uint64_t memory_bytes,
                     const std::string& temp_folder, bool json, const io::ImageOptions& image) {
  ooc::Workspace space(temp_folder, memory_bytes);
  const io::Input input = io::mesh_input(path, format);
  const auto survey = input.read([&] { return std::make_unique<MeshSurvey>(input, format, space, image); });
  if (json)
    survey->print_json();
  else
    survey->print_text();
}

}  // namespace reeb::tools
