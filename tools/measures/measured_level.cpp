#include "tools/measures/measured_level.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "libreeb/base/error.h"
#include "ooc/run/segment.h"
#include "tools/checks/node_places.h"
#include "tools/library/run_input.h"
#include "tools/measures/open_segmentation.h"
#include "tools/program/progress.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

Bucket sum_of(std::span<const Bucket> buckets) {
  Bucket all;
  for (const Bucket& bucket : buckets) merge_into(all, {all.index, bucket.count, bucket.mean});
  return all;
}

double squared_distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

// By arc as measured: the same arc of the level. Parallel arcs of a level are in the order of the file, those of a
// segmentation in the order of their vertices. How many vertices the buckets have, and where, says which is which.
std::vector<std::size_t> arcs_as_measured(const ooc::Level& level, const ooc::MeasuredArcs& measured) {
  const ReebGraph& graph = level.graph;
  std::vector<std::size_t> same(graph.arc_count());
  std::iota(same.begin(), same.end(), std::size_t{0});
  for (std::size_t begin = 0, end = 0; begin < graph.arc_count(); begin = end) {
    while (end < graph.arc_count() && graph.lo[end] == graph.lo[begin] && graph.hi[end] == graph.hi[begin]) ++end;
    // Whether the counts differ, the distance, the place in the level, the place as measured.
    std::vector<std::tuple<bool, double, std::size_t, std::size_t>> matches;
    for (std::size_t a = begin; a < end && end - begin > 1; ++a) {
      const Bucket all = sum_of(level.buckets.view().of(a));
      for (std::size_t b = begin; b < end; ++b)
        matches.emplace_back(all.count != measured.arcs[b].vertices, squared_distance(all.mean, measured.centers[b]), a,
                             b);
    }
    std::sort(matches.begin(), matches.end());
    std::vector<bool> has(end - begin), used(end - begin);
    for (const auto& [differs, distance, a, b] : matches) {
      if (used[a - begin] || has[b - begin]) continue;
      used[a - begin] = has[b - begin] = true;
      same[b] = a;
    }
  }
  return same;
}

// The buckets of arc i become those of arc order[i].
ArcBuckets in_order(const ArcBuckets& buckets, std::span<const std::size_t> order) {
  ArcBuckets result{.offsets = {0}, .buckets = {}};
  result.buckets.reserve(buckets.buckets.size());
  for (const std::size_t arc : order) {
    const auto list = buckets.view().of(arc);
    result.buckets.insert(result.buckets.end(), list.begin(), list.end());
    result.offsets.push_back(result.buckets.size());
  }
  return result;
}

}  // namespace

ooc::MeasuredArcs measure_level(const ooc::ReebFile& file, ooc::Level& level, const MeasureRequest& request) {
  InputOptions opening;
  opening.temp_dir = request.temp_folder;
  opening.image = request.image;
  RunInput input(request.mesh, std::span(&file.header().function, 1), opening);
  if (!input.can_read_again())
    throw Error(ErrorKind::kBadInput, "the mesh must be read twice, and this input can be read once",
                "write the mesh to a file first")
        .at(request.mesh);
  ProgressBar bar(request.quiet);
  ooc::ComputeOptions run = segmentation_run(request.threads, request.temp_folder);
  run.progress = [&](const ooc::ComputeProgress& at) {
    bar.update({"following vertices"}, at.done, at.total, at.triangles);
  };
  const std::uint64_t bound = vertex_bound(file, input.info());
  const auto segmentation = ooc::segment_mesh(input.take_mesh(), *input.functions().front(),
                                              {.file = file,
                                               .version = level.version,
                                               .vertex_bound = bound,
                                               .output = request.temp_folder + "/arcs",
                                               .options = std::move(run)});
  bar.clear();
  ReadOptions reading;
  reading.temp_folder = request.temp_folder;
  const auto reader = input.read_again(reading);
  NodePlaces places(request.mesh, level.graph);
  ooc::MeasuredArcs measured = segmentation->measure(*reader, [&](const MeshBatch& batch) { places.add(batch); });
  input.input().check_unchanged();
  places.finish();
  if (!level.buckets.offsets.empty()) level.buckets = in_order(level.buckets, arcs_as_measured(level, measured));
  if (!request.quiet && measured.doubtful_area + measured.dropped_area > 0)
    print_line(
        fmt::format("note: {:.2g} % of the area is on no arc: {:.2g} % where an edge of the mesh is as high as a loop, "
                    "{:.2g} % with dropped vertices",
                    100 * (measured.doubtful_area + measured.dropped_area) / measured.area,
                    100 * measured.doubtful_area / measured.area, 100 * measured.dropped_area / measured.area));
  return measured;
}

}  // namespace reeb::tools
