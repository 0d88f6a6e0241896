#include "tools/repair/repair_jobs.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "libreeb/repair/curve_cut.h"
#include "libreeb/repair/curve_detour.h"
#include "libreeb/repair/nearby_loop.h"
#include "ooc/patches/ball_clusters.h"
#include "ooc/patches/collected_patches.h"
#include "ooc/patches/far_triangles.h"
#include "ooc/threads/parallel.h"
#include "tools/repair/divided_parts.h"

namespace reeb::tools {
namespace {

// Jobs that are done in one patch.
struct Cluster {
  std::vector<std::uint32_t> jobs;
  std::vector<ooc::Ball> balls;
  bool far_known = false;
  std::vector<ooc::FarTriangle> far;
  bool done = false;
  MeshEdits edits;
  std::vector<RimPair> open;  // by the job: rims between which no way is in the patch
};

std::optional<std::vector<std::uint32_t>> numbers_in(const EditablePatch& patch, std::size_t vertices,
                                                     const std::vector<VertexId>& curve) {
  std::vector<std::uint32_t> numbers;
  for (const VertexId id : curve) {
    std::size_t low = 0, high = vertices;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (patch.vertex(static_cast<std::uint32_t>(middle)).id < id)
        low = middle + 1;
      else
        high = middle;
    }
    if (low == vertices || patch.vertex(static_cast<std::uint32_t>(low)).id != id) return std::nullopt;
    numbers.push_back(static_cast<std::uint32_t>(low));
  }
  return numbers;
}

// The places of triangles that go with others: repetitions of removed ones, and those that repeat a corner along an
// edge that no triangle has any more.
std::vector<std::uint64_t> gone_with_others(const EditablePatch& patch) {
  std::vector<std::uint64_t> gone;
  for (const auto& [t, id] : patch.repetitions())
    if (!patch.triangle(t).there) gone.push_back(id);
  for (const EditablePatch::Line& line : patch.lines())
    if (line.id != EditablePatch::kAdded && patch.lies_bare(line)) gone.push_back(line.id);
  return gone;
}

// Whether an edge of the mesh would be left where triangles were. It cannot be removed.
bool leaves_bare_edge(const EditablePatch& patch) {
  return std::ranges::any_of(patch.lines(), [&](const EditablePatch::Line& line) {
    return line.id == EditablePatch::kAdded && patch.lies_bare(line);
  });
}

// What is different in the patch. `number[v]` becomes what each vertex is in the edits.
MeshEdits edits_of(const EditablePatch& patch, std::vector<VertexRef>& number) {
  MeshEdits edits;
  edits.removed = gone_with_others(patch);
  std::vector<std::uint32_t> of_lines;  // vertices
  for (const EditablePatch::Line& line : patch.lines())
    if (!patch.lies_bare(line)) of_lines.insert(of_lines.end(), {line.a, line.b});
  std::ranges::sort(of_lines);
  const auto keeps_line = [&](std::uint32_t v) { return std::ranges::binary_search(of_lines, v); };
  number.clear();
  for (std::uint32_t v = 0; v < patch.vertex_count(); ++v) {
    const EditablePatch::Vertex& vertex = patch.vertex(v);
    const bool is_new = vertex.id == VertexId::none();
    number.push_back({is_new ? 0 : vertex.id.value(), is_new});
    if (is_new) {
      if (!patch.is_used(v)) {  // a later cut removed it
        number[v] = number[vertex.parents[0]];
        continue;
      }
      NewVertex added{vertex.position, {}};
      for (std::size_t k = 0; k < 3; ++k) added.parents[k] = number[vertex.parents[k]];
      number[v].number = edits.vertices.size();
      edits.vertices.push_back(added);
      continue;
    }
    if (vertex.whole && !vertex.used_elsewhere && !patch.all_at(v).empty() && !patch.is_used(v) && !keeps_line(v))
      edits.dropped.push_back(vertex.id.value());
  }
  for (std::uint32_t t = 0; t < patch.triangle_count(); ++t) {
    const EditablePatch::Triangle& triangle = patch.triangle(t);
    if (triangle.id != EditablePatch::kAdded) {
      if (!triangle.there) edits.removed.push_back(triangle.id);
    } else if (triangle.there) {
      const auto& c = triangle.corners;
      edits.triangles.push_back({number[c[0]], number[c[1]], number[c[2]]});
    }
  }
  return edits;
}

class Jobs {
 public:
  Jobs(const ValuedMesh& mesh, const std::vector<RepairJob>& jobs, const PatchScale& scale, ooc::Workspace& space,
       const JobOptions& options)
      : mesh_(mesh),
        jobs_(jobs),
        scale_(scale),
        space_(space),
        options_(options),
        left_out_(jobs.size(), 0),
        too_small_(jobs.size(), 0),
        cluster_of_(jobs.size(), 0) {
    done_.results.resize(jobs.size());
    for (const RepairJob& job : jobs) {
      ooc::Ball ball;
      for (std::size_t k = 0; k < 3; ++k) ball.center[k] = (job.box[0][k] + job.box[1][k]) / 2;
      ball.radius = distance(job.box[0], job.box[1]) / 2 + kReach * edge_of(job);
      balls_.push_back(ball);
    }
  }

  JobsDone run() {
    make_clusters();
    for (int round = 0; round < kMostRounds; ++round) {
      find_far();
      read_patches();
      if (round < kMostDoublings && enlarge()) continue;
      if (!leave_out_dividing()) break;
    }
    for (Cluster& cluster : clusters_) {
      done_.edits.add(cluster.edits);
      cluster = {};
    }
    done_.edits.sort();
    return std::move(done_);
  }

 private:
  static constexpr double kReach = 6, kLeastEdge = 0.25;  // of a patch beyond its curve, in edges
  static constexpr int kMostDoublings = 3, kMostRounds = 20;

  double edge_of(const RepairJob& job) const {
    return std::max(job.length / static_cast<double>(job.curve.size()), kLeastEdge * scale_.edge);
  }

  void make_clusters() {
    std::vector<Cluster> clusters;
    for (const auto& members : ooc::clusters_of(balls_)) {
      Cluster cluster;
      cluster.jobs = members;
      for (const std::uint32_t j : members) cluster.balls.push_back(balls_[j]);
      // What was done stays done as long as the same jobs are together.
      if (!clusters_.empty())
        if (Cluster& old = cluster_of(members.front()); old.done && old.jobs == cluster.jobs) cluster = std::move(old);
      clusters.push_back(std::move(cluster));
    }
    clusters_ = std::move(clusters);
    for (std::uint32_t i = 0; i < clusters_.size(); ++i)
      for (const std::uint32_t j : clusters_[i].jobs) cluster_of_[j] = i;
  }

  Cluster& cluster_of(std::uint32_t job) { return clusters_[cluster_of_[job]]; }

  // A triangle with a corner outside its patch is not in it. A small one stays near its rim.
  void find_far() {
    constexpr double kSmall = kReach / 2;  // in edges
    std::vector<ooc::PatchBall> places;
    std::vector<Cluster*> now;
    for (Cluster& cluster : clusters_) {
      if (cluster.far_known) continue;
      for (const std::uint32_t j : cluster.jobs)
        places.push_back({balls_[j], static_cast<std::uint32_t>(now.size()), kSmall * edge_of(jobs_[j])});
      now.push_back(&cluster);
    }
    if (now.empty()) return;
    mesh_.look_up(space_, [&](IndexedMesh& mesh) {
      ooc::FarTriangles found =
          ooc::find_far_triangles(mesh, places, now.size(), space_.budget, [&](const IndexedMesh& read) {
            if (options_.progress) options_.progress(read.bytes_read(), read.bytes_total());
          });
      for (std::size_t i = 0; i < now.size(); ++i) {
        now[i]->far = std::move(found.of_patch[i]);
        now[i]->far_known = true;
      }
      far_memory_.push_back(std::move(found.memory));
    });
  }

  // Its corners that are in the patch have numbers there.
  static void add_obstacles(EditablePatch& patch, std::size_t vertices, const std::vector<ooc::FarTriangle>& far) {
    for (const ooc::FarTriangle& triangle : far) {
      PlacedTriangle placed{{}, triangle.points};
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto number = numbers_in(patch, vertices, {triangle.corners[k]});
        placed.corners[k] = number ? number->front() : EditablePatch::kOutside + k;
      }
      patch.add_obstacle(placed);
    }
  }

  // All in one reading, then as many at a time as the memory holds.
  void read_patches() {
    const double most = static_cast<double>(options_.patch_bytes) / kBytesPerVertex;
    std::vector<Cluster*> now;
    std::vector<std::uint32_t> first_of_group, patch_of;
    std::vector<ooc::Ball> balls;
    double sum = most;
    for (Cluster& cluster : clusters_) {
      if (cluster.done) continue;
      const auto patch = static_cast<std::uint32_t>(now.size());
      if (sum >= most && first_of_group.size() < ooc::CollectedPatches::kMostGroups) {
        first_of_group.push_back(patch);
        sum = 0;
      }
      for (const ooc::Ball& ball : cluster.balls) {
        sum += scale_.vertices(ball.radius);
        balls.push_back(ball);
        patch_of.push_back(patch);
      }
      now.push_back(&cluster);
    }
    if (now.empty()) return;
    first_of_group.push_back(static_cast<std::uint32_t>(now.size()));
    ooc::CollectedPatches patches(balls, patch_of, first_of_group, space_.temp, space_.budget);
    mesh_.read(
        [&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
          patches.add(batch);
          if (options_.progress) options_.progress(done, total);
        });
    patches.finish();
    done_.mesh_vertices = patches.mesh_vertices();
    done_.mesh_triangles = patches.mesh_triangles();
    for (std::size_t g = 0; g + 1 < first_of_group.size(); ++g) {
      const ooc::PatchGroup group = patches.group(g);
      const std::uint32_t first = first_of_group[g];
      ooc::in_parallel(options_.threads, first_of_group[g + 1] - first,
                       [&](std::size_t i) { work(group.patch(i), *now[first + i]); });
    }
  }

  void work(EditablePatch patch, Cluster& cluster) {
    const std::size_t vertices = patch.vertex_count();
    add_obstacles(patch, vertices, cluster.far);
    struct Open {
      std::uint32_t job;
      std::vector<std::uint32_t> first, second;
    };
    std::vector<Open> open;
    const bool has_edges = std::ranges::any_of(
        patch.lines(), [](const EditablePatch::Line& line) { return line.id == EditablePatch::kAdded; });
    EditablePatch::State before;
    std::size_t gone = 0;
    for (const std::uint32_t j : cluster.jobs) {
      if (has_edges) before = patch.state();
      JobResult& result = done_.results[j];
      const auto curve = numbers_in(patch, vertices, jobs_[j].curve);
      Cut cut;
      if (!curve)
        cut.why = "its curve is not on the surface";
      else if (jobs_[j].is_boundary)
        cut = close_boundary(patch, *curve, {options_.float32});
      else if (left_out_[j] != 0)
        cut.why = "cutting along it would divide the surface";
      else
        cut = cut_along(patch, with_detours(patch, *curve), {options_.float32});
      if (curve && !jobs_[j].is_boundary && !cut.done && !cut.too_small)
        cut_nearby(patch, *curve, jobs_[j].length, cut);
      if (has_edges && cut.done && leaves_bare_edge(patch)) {
        patch.go_back(before);
        cut = {};
        cut.why = "an edge of the file would be left across the cut";
      }
      // Where edges seem to be missing, the patch may end.
      const bool whole = curve && std::ranges::all_of(*curve, [&](std::uint32_t v) { return patch.vertex(v).whole; });
      too_small_[j] = !cut.done && (cut.too_small || !whole) ? 1 : 0;
      const std::size_t gone_before = std::exchange(gone, gone_with_others(patch).size());
      result = {cut.done, std::move(cut.why), cut.removed + gone - gone_before, cut.added, cut.volume};
      if (cut.done && !cut.connected) open.push_back({j, std::move(cut.first_side), std::move(cut.second_side)});
    }
    std::vector<VertexRef> number;
    cluster.edits = edits_of(patch, number);
    cluster.open.clear();
    for (const Open& rims : open) {
      const auto left = [&](const std::vector<std::uint32_t>& rim) {
        const auto it = std::ranges::find_if(rim, [&](std::uint32_t v) { return patch.is_used(v); });
        return it == rim.end() ? std::optional<VertexRef>{} : number[*it];
      };
      cluster.open.push_back({rims.job, left(rims.first), left(rims.second)});
    }
    cluster.done = true;
  }

  // Earlier repairs changed the surface at the curve, or another one is as good: cuts along a loop that divides
  // nothing.
  void cut_nearby(EditablePatch& patch, const std::vector<std::uint32_t>& curve, double length, Cut& cut) const {
    constexpr double kMostLonger = 1.5;
    std::vector<std::uint32_t> near;
    for (const std::uint32_t v : curve)
      if (patch.is_used(v)) near.push_back(v);
    if (near.empty())
      for (const std::uint32_t v : curve)
        for (const std::uint32_t t : patch.all_at(v))
          for (const std::uint32_t w : patch.triangle(t).corners) near.push_back(w);
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    const auto loop = nearby_loop(patch, near, kMostLonger * length);
    if (loop.empty()) return;
    if (Cut other = cut_along(patch, loop, {options_.float32}); other.done) cut = std::move(other);
  }

  // Doubles the balls of jobs whose patches were too small. Returns whether there was one.
  bool enlarge() {
    bool any = false;
    for (std::uint32_t j = 0; j < jobs_.size(); ++j) {
      if (done_.results[j].done || too_small_[j] == 0 || scale_.too_large(2 * balls_[j].radius)) continue;
      balls_[j].radius *= 2;
      any = true;
      cluster_of(j).done = false;
    }
    if (any) make_clusters();
    return any;
  }

  // Returns whether there was one.
  bool leave_out_dividing() {
    if (std::ranges::all_of(clusters_, [](const Cluster& cluster) { return cluster.open.empty(); })) return false;
    std::vector<RimPair> open;
    MeshEdits edits;
    for (const Cluster& cluster : clusters_) {
      for (RimPair pair : cluster.open) {
        for (std::optional<VertexRef>* side : {&pair.first, &pair.second})
          if (*side && (*side)->is_new) (*side)->number += edits.vertices.size();
        open.push_back(pair);
      }
      edits.add(cluster.edits);
    }
    std::sort(open.begin(), open.end(), [](const RimPair& a, const RimPair& b) { return a.job < b.job; });
    edits.sort();
    const auto dividing =
        dividing_curves(mesh_, edits, done_.mesh_vertices, open, space_, [&](std::uint64_t done, std::uint64_t total) {
          if (options_.progress) options_.progress(done, total);
        });
    for (const auto& [job, why] : dividing) {
      left_out_[job] = 1;
      done_.results[job] = {};
      done_.results[job].why = why;
      cluster_of(job).done = false;
    }
    return !dividing.empty();
  }

  static constexpr double kBytesPerVertex = 220;

  const ValuedMesh& mesh_;
  const std::vector<RepairJob>& jobs_;
  const PatchScale& scale_;
  ooc::Workspace& space_;
  const JobOptions& options_;
  std::vector<Reservation> far_memory_;
  std::vector<std::uint8_t> left_out_, too_small_;
  std::vector<std::uint32_t> cluster_of_;  // by job: its place in clusters_
  std::vector<ooc::Ball> balls_;
  std::vector<Cluster> clusters_;
  JobsDone done_;
};

}  // namespace

JobsDone run_jobs(const ValuedMesh& mesh, const std::vector<RepairJob>& jobs, const PatchScale& scale,
                  ooc::Workspace& space, const JobOptions& options) {
  return Jobs(mesh, jobs, scale, space, options).run();
}

}  // namespace reeb::tools
