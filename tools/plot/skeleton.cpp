#include "tools/plot/skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/mesh_reader.h"
#include "ooc/tables/paged_table.h"
#include "tools/checks/node_places.h"
#include "tools/defects/valued_mesh.h"
#include "tools/plot/charts.h"

namespace reeb::tools {
namespace {

double along(const Point& direction, const Point& position) {
  return direction[0] * position[0] + direction[1] * position[1] + direction[2] * position[2];
}

// The directions across and upwards of these views, those that are parallel to others left out.
std::vector<Point> sides_of(std::span<const io::View> views) {
  std::vector<Point> sides;
  for (const io::View& view : views)
    for (const Point& side : {view.right, view.up}) {
      const auto is_parallel = [&](const Point& other) { return std::abs(along(side, other)) > 1 - 1e-12; };
      if (std::ranges::none_of(sides, is_parallel)) sides.push_back(side);
    }
  return sides;
}

// Some vertices of a mesh, evenly by their indices, and those that reach farthest to the sides of some views: a picture
// with any of these views that has room for them has room for all.
class VertexSample {
 public:
  explicit VertexSample(std::span<const io::View> views) : sides_(sides_of(views)), farthest_(2 * sides_.size()) {}

  void add(const MeshBatch& batch) {
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const Point position = batch.position(i);
      for (std::size_t k = 0; k < sides_.size(); ++k) {
        const double reach = along(sides_[k], position);
        farthest_[2 * k].take(-reach, position);
        farthest_[2 * k + 1].take(reach, position);
      }
      if (count_++ % step_ != 0) continue;
      points_.push_back(position);
      if (points_.size() < 2 * kEnough) continue;
      for (std::size_t k = 0; k < kEnough; ++k) points_[k] = points_[2 * k];
      points_.resize(kEnough);
      step_ *= 2;
    }
  }
  std::vector<Point> points() const {
    std::vector<Point> all = points_;
    if (count_ != 0)
      for (const Farthest& one : farthest_) all.push_back(one.position);
    return all;
  }

 private:
  static constexpr std::size_t kEnough = 20000;

  struct Farthest {
    double reach = -std::numeric_limits<double>::infinity();
    Point position{};

    void take(double other_reach, const Point& other) {
      if (other_reach <= reach) return;
      reach = other_reach;
      position = other;
    }
  };

  std::vector<Point> sides_, points_;
  std::vector<Farthest> farthest_;  // of each side, the way back and the way there
  std::uint64_t count_ = 0, step_ = 1;
};

// The axis that a function follows is upright.
Point upright_of(const std::string& function) {
  if (function == "x" || function == "c0") return {1, 0, 0};
  if (function == "y" || function == "c1") return {0, 1, 0};
  return {0, 0, 1};
}

// Draws the triangles of a mesh, and the sides of its cells.
class SurfaceDrawing {
 public:
  SurfaceDrawing(const SkeletonOptions& options, const FileHeader& header, const io::Projection& projection,
                 io::SurfaceRaster& raster)
      : header_(header),
        projection_(projection),
        raster_(raster),
        temp_(options.temp_folder),
        corners_("corners of the picture", temp_, budget_, kTableBytes, io::SurfacePoint{}) {}

  void add(const MeshBatch& batch, std::span<const std::vector<double>> values) {
    const double low = header_.function_min / 2, range = header_.function_max / 2 - low;
    placed_.clear();
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      const Point position = batch.position(i);
      const io::PicturePoint at = projection_.place(position);
      const double share = values.empty() || !(range > 0) ? 0 : (values[0][i] / 2 - low) / range;
      placed_.push_back({static_cast<float>(at.x - io::kSkeletonCorner.x),
                         static_cast<float>(at.y - io::kSkeletonCorner.y),
                         static_cast<float>(projection_.depth(position)), static_cast<float>(share)});
    }
    corners_.write(batch.first_vertex.value(), placed_);
    batch.for_each_simplex([&](std::span<const VertexId> simplex) {
      for (std::size_t i = 0; i < simplex.size(); ++i)
        for (std::size_t j = i + 1; j < simplex.size(); ++j)
          for (std::size_t k = j + 1; k < simplex.size(); ++k)
            raster_.triangle({corner(simplex[i]), corner(simplex[j]), corner(simplex[k])}, simplex.size() == 3);
    });
  }

 private:
  static constexpr std::uint64_t kTableBytes = std::uint64_t{256} << 20;

  io::SurfacePoint corner(VertexId vertex) { return corners_.get(vertex.value()); }

  const FileHeader& header_;
  const io::Projection& projection_;
  io::SurfaceRaster& raster_;
  MemoryBudget budget_;
  io::TempDir temp_;
  ooc::PagedTable<io::SurfacePoint> corners_;
  std::vector<io::SurfacePoint> placed_;
};

// Some vertices of the mesh, which is read a first time, and all that bound it in these views. THROWS: Error if the
// file and its graph are not of this mesh.
std::vector<Point> measure_mesh(const ValuedMesh& mesh, const ooc::ReebFile& file, const ReebGraph& graph,
                                std::span<const io::View> views, const SkeletonOptions& options) {
  VertexSample sample(views);
  NodePlaces places(mesh.path(), graph);
  mesh.read([&](const MeshBatch& batch, auto, std::uint64_t done, std::uint64_t total) {
    sample.add(batch);
    places.add(batch);
    if (options.progress) options.progress("measuring", done, total);
  });
  places.finish(file.path(), file.header());
  return sample.points();
}

// Where the picture has the points of lines, to be compared with the surface.
std::vector<io::Probe> probes_at(std::span<const Point> stops, const io::Projection& projection) {
  std::vector<io::Probe> probes;
  for (const Point& stop : stops) {
    const io::PicturePoint at = projection.place(stop);
    // A line that touches the surface is not behind it.
    constexpr double kTolerance = 0.5;
    probes.push_back({static_cast<float>(at.x - io::kSkeletonCorner.x),
                      static_cast<float>(at.y - io::kSkeletonCorner.y),
                      static_cast<float>(projection.depth(stop) + kTolerance)});
  }
  return probes;
}

// Reads the mesh a second time.
void draw_surface(const ValuedMesh& mesh, const SkeletonOptions& options, const FileHeader& header,
                  const io::Projection& projection, io::SurfaceRaster& raster) {
  SurfaceDrawing drawing(options, header, projection, raster);
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>> values, std::uint64_t done,
                std::uint64_t total) {
    drawing.add(batch, values);
    if (options.progress) options.progress("drawing", done, total);
  });
}

}  // namespace

void require_surface_points(const ooc::ReebFile& file) {
  const FileFlags& flags = file.header().flags;
  if (!flags.has_embedding)
    throw Error(ErrorKind::kBadInput, "this file has no points of the surface: it was computed with --buckets 0",
                "leave --on-surface out, or compute the graph with buckets")
        .at(file.path());
  if (!flags.has_spreads)
    throw Error(ErrorKind::kBadInput,
                "this file was written by an earlier version, which did not record points of the surface",
                "leave --on-surface out, or compute the graph of the mesh again")
        .at(file.path());
}

std::string draw_skeleton(const ooc::ReebFile& file, const SkeletonOptions& options) {
  const FileHeader& header = file.header();
  if (options.on_surface) require_surface_points(file);
  const ChosenLevel chosen = choose_level(file, options.level);
  const ooc::Level level = file.load(chosen.version);
  const io::GraphView view{
      level.graph, header.function,          level.threshold,   level.buckets.view(), header.bucket_exponent,
      {},          header.flags.has_spreads, options.on_surface};
  io::Heading heading{graph_name(file) + ", f = " + header.function + ": skeleton",
                      chosen.text + ", " + counts_text(level.graph)};
  const bool is_empty = level.graph.nodes.empty();
  if (!is_empty && level.graph.positions.empty())
    throw Error(ErrorKind::kBadInput, "the file has no positions of nodes",
                "draw it with --kind graph, or compute it again with `reeb compute`")
        .at(file.path());
  const io::SkeletonLines lines = io::skeleton_lines(view);
  const std::vector<Point> stops = io::all_points(lines);

  const MeshSource source{options.mesh, options.format, options.temp_folder, MemoryBudget::kUnlimited, options.image};
  std::optional<ValuedMesh> mesh;
  const Point upright = upright_of(header.function);
  std::vector<io::View> views;
  if (options.view)
    views.push_back(io::view_from(*options.view, upright));
  else
    views = io::views_around(upright);
  std::vector<Point> all;
  if (!options.mesh.empty()) {
    std::vector<std::string> functions;
    if (options.surface == io::SurfaceStyle::kValue) functions.push_back(header.function);
    mesh.emplace(source, functions);
    all = measure_mesh(*mesh, file, level.graph, views, options);
  }
  if (is_empty) return message_picture(heading, "The graph is empty.");

  const io::View eye = options.view ? views.front() : io::best_view(all, stops, upright);
  all.insert(all.end(), stops.begin(), stops.end());
  all.insert(all.end(), lines.nodes.begin(), lines.nodes.end());
  const io::Projection projection(eye, all, io::kSkeletonCorner, io::kSkeletonBoxWidth, io::kSkeletonMostHeight);
  heading.subtitle += ", seen from " + io::direction_text(eye.toward);
  io::SkeletonScene scene{projection, nullptr, options.surface, options.colors, {}};
  if (!mesh || options.surface == io::SurfaceStyle::kNone) {
    scene.style = io::SurfaceStyle::kNone;
    return skeleton_picture(view, lines, scene, heading);
  }

  constexpr double kScale = 1.6;
  io::SurfaceRaster raster(io::kSkeletonBoxWidth, projection.height(), kScale, options.surface,
                           probes_at(stops, projection));
  draw_surface(*mesh, options, header, projection, raster);
  const io::Raster image = raster.image();
  scene.surface = &image;
  scene.layers = raster.layers();
  return skeleton_picture(view, lines, scene, heading);
}

}  // namespace reeb::tools
