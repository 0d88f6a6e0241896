#include "tools/measures/measured_level.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <utility>

#include "libreeb/base/error.h"
#include "tools/library/run_input.h"
#include "tools/measures/open_segmentation.h"
#include "tools/program/progress.h"
#include "tools/program/wrapping.h"

namespace reeb::tools {
namespace {

std::array<double, 3> center_of(std::span<const Bucket> buckets) {
  Bucket all;
  for (const Bucket& bucket : buckets) merge_into(all, {all.index, bucket.count, bucket.mean});
  return all.mean;
}

double squared_distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

// A segmentation has an order of parallel arcs of its own. Where the vertices of the buckets lie says which is which.
void order_as_in(const ooc::Level& level, ooc::MeasuredArcs& measured) {
  const ReebGraph& graph = level.graph;
  if (level.buckets.view().empty()) return;
  for (std::size_t begin = 0, end = 0; begin < graph.arc_count(); begin = end) {
    while (end < graph.arc_count() && graph.lo[end] == graph.lo[begin] && graph.hi[end] == graph.hi[begin]) ++end;
    std::vector<std::tuple<double, std::size_t, std::size_t>> matches;  // distance, place in the level, place measured
    for (std::size_t a = begin; a < end && end - begin > 1; ++a)
      for (std::size_t b = begin; b < end; ++b)
        matches.emplace_back(squared_distance(center_of(level.buckets.view().of(a)), measured.centers[b]), a, b);
    std::sort(matches.begin(), matches.end());
    const std::vector<ArcMeasures> before(measured.arcs.begin() + static_cast<std::ptrdiff_t>(begin),
                                          measured.arcs.begin() + static_cast<std::ptrdiff_t>(end));
    std::vector<bool> has(end - begin), used(end - begin);
    for (const auto& [distance, a, b] : matches) {
      if (has[a - begin] || used[b - begin]) continue;
      has[a - begin] = used[b - begin] = true;
      measured.arcs[a] = before[b - begin];
    }
  }
}

}  // namespace

ooc::MeasuredArcs measure_level(const ooc::ReebFile& file, const ooc::Level& level, const MeasureRequest& request) {
  InputOptions opening;
  opening.temp_dir = request.temp_folder;
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
  ooc::Segmentation segmentation(input.take_mesh(), *input.functions().front(), bound, file, level.version,
                                 request.temp_folder + "/arcs", std::move(run));
  bar.clear();
  ReadOptions reading;
  reading.temp_folder = request.temp_folder;
  const auto reader = input.read_again(reading);
  ooc::MeasuredArcs measured = segmentation.measure(*reader);
  input.input().check_unchanged();
  order_as_in(level, measured);
  if (!request.quiet && measured.doubtful_area + measured.dropped_area > 0)
    print_line(
        fmt::format("note: {:.2g} % of the area is on no arc: {:.2g} % where an edge of the mesh is as high as a loop, "
                    "{:.2g} % with dropped vertices",
                    100 * (measured.doubtful_area + measured.dropped_area) / measured.area,
                    100 * measured.doubtful_area / measured.area, 100 * measured.dropped_area / measured.area));
  return measured;
}

}  // namespace reeb::tools
