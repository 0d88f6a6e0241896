#include "tools/repair/surface_cleaning.h"

#include <algorithm>
#include <array>
#include <compare>
#include <map>
#include <span>
#include <utility>

#include "libreeb/base/error.h"
#include "libreeb/containers/union_find.h"
#include "ooc/sorting/external_sort.h"

namespace reeb::tools {
namespace {

using Progress = std::function<void(std::uint64_t done, std::uint64_t total)>;

struct CornerSet {
  std::array<std::uint64_t, 3> corners;  // ascending
  std::uint64_t place;
  friend auto operator<=>(const CornerSet&, const CornerSet&) = default;
};

struct EdgeSide {
  std::uint64_t a, b, third;  // a < b
  friend auto operator<=>(const EdgeSide&, const EdgeSide&) = default;
};

class Cleaner {
 public:
  Cleaner(const ValuedMesh& mesh, const CleaningOptions& options, ooc::Workspace& space, const Progress& progress)
      : mesh_(mesh),
        options_(options),
        space_(space),
        progress_(progress),
        corner_sets_("repeated triangles", space.temp, space.budget, sorting()),
        sides_("sides of edges", space.temp, space.budget, sorting()),
        removed_memory_(space.budget.reserve("removed triangles", 0)),
        part_memory_(space.budget.reserve("components", 0)),
        end_memory_(space.budget.reserve("positions of boundaries", 0)) {}

  Cleaning run() {
    read();
    if (options_.duplicates) list_duplicates();
    if (options_.components_percent) list_components();
    std::sort(result_.removed.begin(), result_.removed.end());
    result_.removed.erase(std::unique(result_.removed.begin(), result_.removed.end()), result_.removed.end());
    if (options_.boundary_length) list_boundaries();
    return std::move(result_);
  }

 private:
  using Edge = std::pair<std::uint64_t, std::uint64_t>;
  struct End {
    std::uint64_t vertex;
    Point position;
  };

  ooc::SortOptions sorting() const {
    ooc::SortOptions options;
    options.allowance_bytes = std::min<std::uint64_t>(space_.share(), 64u << 20);
    return options;
  }

  void for_each_triangle(const std::function<void(std::array<std::uint64_t, 3>, std::uint64_t)>& visit) {
    std::uint64_t place = 0;
    mesh_.read(
        [&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
          vertices_ = std::max(vertices_, batch.first_vertex.value() + batch.vertex_count);
          const auto& corners = batch.triangles();
          for (std::size_t i = 0; i < corners.size(); i += 3, ++place)
            visit({corners[i].value(), corners[i + 1].value(), corners[i + 2].value()}, place);
          if (options_.components_percent && batch.edges().size() > 0)
            for (std::size_t i = 0; i < batch.edges().size(); i += 2)
              join(batch.edges()[i].value(), batch.edges()[i + 1].value());
          progress_(done, total);
        });
  }

  void remove(std::uint64_t place) {
    std::vector<std::uint64_t>& removed = result_.removed;
    if (removed.size() == removed.capacity()) {
      const std::size_t larger = std::max<std::size_t>(2 * removed.size(), 1024);
      removed_memory_.resize((removed.size() + larger) * sizeof place);  // both are there while it grows
      removed.reserve(larger);
      removed_memory_.resize(larger * sizeof place);
    }
    removed.push_back(place);
  }

  void join(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t most = std::max(a, b);
    if (most >= (std::uint64_t{1} << 32) - 1)
      throw Error(ErrorKind::kResource, "the mesh has too many vertices for --drop-components", "leave it out");
    if (most >= part_.size()) {
      part_memory_.resize(8 * (most + 1));  // a vector grows by doubling
      while (part_.size() <= most) part_.add();
    }
    part_.unite(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
  }

  static bool is_degenerate(const std::array<std::uint64_t, 3>& c) {
    return c[0] == c[1] || c[1] == c[2] || c[0] == c[2];
  }

  // A triangle that is removed anyway connects nothing.
  bool is_removed(const std::array<std::uint64_t, 3>& corners) const {
    return options_.degenerate && is_degenerate(corners);
  }

  void read() {
    for_each_triangle([&](std::array<std::uint64_t, 3> c, std::uint64_t place) {
      if (is_removed(c)) {
        ++result_.degenerate;
        remove(place);
        if (options_.components_percent) note_removed(c);
        return;
      }
      if (options_.components_percent) {
        join(c[0], c[1]);
        join(c[0], c[2]);
      }
      if (is_degenerate(c)) return;
      std::sort(c.begin(), c.end());
      if (options_.duplicates) corner_sets_.add({c, place});
      if (options_.boundary_length) {
        sides_.add({c[0], c[1], c[2]});
        sides_.add({c[0], c[2], c[1]});
        sides_.add({c[1], c[2], c[0]});
      }
    });
  }

  void note_removed(const std::array<std::uint64_t, 3>& corners) {
    const std::uint64_t most = *std::ranges::max_element(corners);
    if (most >= of_removed_.size()) of_removed_.resize(most + 1, false);
    for (const std::uint64_t v : corners) of_removed_[v] = true;
  }

  void list_duplicates() {
    corner_sets_.finish();
    std::vector<CornerSet> block;
    std::array<std::uint64_t, 3> last{};
    bool any = false;
    while (corner_sets_.read(block, kBlock)) {
      for (const CornerSet& set : block) {
        if (any && set.corners == last) {
          ++result_.duplicates;
          remove(set.place);
        }
        last = set.corners;
        any = true;
      }
    }
  }

  void list_components() {
    constexpr std::size_t kSizeBytes = 64, kSizesAtOnce = 4096;  // a node of the map
    Reservation memory = space_.budget.reserve("sizes of components", 0);
    std::map<std::uint32_t, std::uint64_t> sizes;
    for_each_triangle([&](const std::array<std::uint64_t, 3>& c, std::uint64_t) {
      if (is_removed(c)) return;
      if (memory.bytes() < kSizeBytes * (sizes.size() + 1)) memory.resize(kSizeBytes * (sizes.size() + kSizesAtOnce));
      sizes[part_.find(static_cast<std::uint32_t>(c[0]))] += is_degenerate(c) ? 0u : 1u;
    });
    std::uint64_t largest = 0;
    for (const auto& [root, size] : sizes) largest = std::max(largest, size);
    const double least = *options_.components_percent / 100 * static_cast<double>(largest);
    const auto is_small = [&](std::uint32_t root) { return static_cast<double>(sizes.at(root)) < least; };
    for (const auto& [root, size] : sizes) result_.components += is_small(root) ? 1u : 0u;
    count_isolated(sizes);
    if (result_.components == 0) return;
    for_each_triangle([&](const std::array<std::uint64_t, 3>& c, std::uint64_t place) {
      if (is_removed(c) || !is_small(part_.find(static_cast<std::uint32_t>(c[0])))) return;
      ++result_.component_triangles;
      remove(place);
    });
    result_.in_dropped.resize(vertices_, false);
    for (std::uint32_t v = 0; v < part_.size(); ++v)
      if (const std::uint32_t root = part_.find(v); sizes.contains(root) && is_small(root))
        result_.in_dropped[v] = true;
  }

  void count_isolated(const std::map<std::uint32_t, std::uint64_t>& sizes) {
    std::vector<bool> has_others(part_.size(), false);
    for (std::uint32_t v = 0; v < part_.size(); ++v)
      if (const std::uint32_t root = part_.find(v); root != v) has_others[root] = true;
    // Vertices that only removed triangles had are removed with them.
    for (std::uint64_t v = 0; v < vertices_; ++v) {
      if (v < of_removed_.size() && of_removed_[v]) continue;
      const auto root = static_cast<std::uint32_t>(v);
      const bool is_alone = v >= part_.size() || (part_.find(root) == root && !has_others[v] && !sizes.contains(root));
      result_.isolated += is_alone ? 1u : 0u;
    }
  }

  bool is_dropped(std::uint64_t v) const { return v < result_.in_dropped.size() && result_.in_dropped[v]; }

  void list_boundaries() {
    std::vector<Edge> edges;
    Reservation memory = space_.budget.reserve("edges of boundaries", 0);
    sides_.finish();
    std::vector<EdgeSide> block;
    EdgeSide last{};
    bool any = false, alone = false;
    const auto end_edge = [&] {
      if (!any || !alone || is_dropped(last.a)) return;
      if (edges.size() == edges.capacity()) {
        const std::size_t larger = std::max<std::size_t>(2 * edges.size(), 1024);
        memory.resize((edges.size() + larger) * sizeof(Edge));
        edges.reserve(larger);
      }
      edges.emplace_back(last.a, last.b);
      edges.emplace_back(last.b, last.a);
    };
    while (sides_.read(block, kBlock))
      for (const EdgeSide& side : block) {
        if (any && side.a == last.a && side.b == last.b) {
          alone = alone && side.third == last.third;
          continue;
        }
        end_edge();
        last = side;
        any = alone = true;
      }
    end_edge();
    memory.resize(edges.capacity() * sizeof(Edge));
    std::sort(edges.begin(), edges.end());
    list_ends(edges);
    find_paths(edges);
  }

  // The first ends of all edges.
  void list_ends(const std::vector<Edge>& edges) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) count += i == 0 || edges[i].first != edges[i - 1].first ? 1u : 0u;
    end_memory_.resize(count * sizeof(End));
    ends_.reserve(count);
    auto next = edges.begin();
    if (!edges.empty())
      mesh_.read(
          [&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
            const std::uint64_t first = batch.first_vertex.value();
            for (; next != edges.end() && next->first < first + batch.vertex_count; ++next) {
              if (!ends_.empty() && ends_.back().vertex == next->first) continue;
              ends_.push_back({next->first, batch.position(next->first - first)});
            }
            progress_(done, total);
          });
    count_seams();
  }

  void count_seams() {
    std::ranges::sort(ends_, {}, &End::position);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const Point& here = ends_[i].position;
      if ((i > 0 && here == ends_[i - 1].position) || (i + 1 < ends_.size() && here == ends_[i + 1].position))
        ++result_.seam_vertices;
    }
    std::ranges::sort(ends_, {}, &End::vertex);
  }

  const Point& position(std::uint64_t v) const {
    return std::ranges::lower_bound(ends_, v, {}, &End::vertex)->position;
  }

  void find_paths(const std::vector<Edge>& edges) {
    const Reservation memory = space_.budget.reserve("paths of boundaries", kPathBytes * edges.size());
    std::vector<bool> seen(edges.size(), false);
    const auto first_of = [&](std::uint64_t v) {
      return static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), Edge(v, 0)) - edges.begin());
    };
    for (std::size_t start = 0; start < edges.size(); ++start) {
      if (seen[start]) continue;
      // All edges that are connected with this one.
      std::vector<std::uint64_t> open = {edges[start].first}, members;
      bool simple = true;
      double sum = 0;
      while (!open.empty()) {
        const std::uint64_t v = open.back();
        open.pop_back();
        std::size_t i = first_of(v);
        if (seen[i]) continue;
        members.push_back(v);
        std::size_t count = 0;
        for (; i < edges.size() && edges[i].first == v; ++i, ++count) {
          seen[i] = true;
          open.push_back(edges[i].second);
          sum += distance(position(v), position(edges[i].second)) / 2;
        }
        simple = simple && count == 2;
      }
      // A length that was printed can be less by the last digit.
      constexpr double kRounding = 1 + 1e-12;
      if (!(sum <= *options_.boundary_length * kRounding)) {
        ++result_.long_boundaries;
        continue;
      }
      if (!simple || members.size() < 3) {
        ++result_.pinched_boundaries;
        continue;
      }
      RepairJob job;
      job.length = sum;
      job.is_boundary = true;
      job.box = {position(members[0]), position(members[0])};
      std::uint64_t v = members[0], before = edges[first_of(v)].second;
      for (std::size_t i = 0; i < members.size(); ++i) {
        job.curve.emplace_back(v);
        for (std::size_t k = 0; k < 3; ++k) {
          job.box[0][k] = std::min(job.box[0][k], position(v)[k]);
          job.box[1][k] = std::max(job.box[1][k], position(v)[k]);
        }
        const std::size_t at = first_of(v);
        const std::uint64_t next = edges[at].second == before ? edges[at + 1].second : edges[at].second;
        before = v;
        v = next;
      }
      result_.boundaries.push_back(std::move(job));
    }
  }

  static constexpr std::size_t kBlock = 4096;
  // Of an edge in one direction: the vertices that are open and those that were seen, in vectors that grow by doubling.
  static constexpr std::size_t kPathBytes = 32;

  const ValuedMesh& mesh_;
  const CleaningOptions& options_;
  ooc::Workspace& space_;
  const Progress& progress_;
  ooc::ExternalSort<CornerSet> corner_sets_;
  ooc::ExternalSort<EdgeSide> sides_;
  Reservation removed_memory_, part_memory_;
  UnionFind part_;
  std::vector<bool> of_removed_;  // by vertex: a corner of a degenerate triangle that is removed
  Reservation end_memory_;
  std::vector<End> ends_;  // by vertex
  std::uint64_t vertices_ = 0;
  Cleaning result_;
};

}  // namespace

Cleaning plan_cleaning(const ValuedMesh& mesh, const CleaningOptions& options, ooc::Workspace& space,
                       const Progress& progress) {
  if (!options.any()) return {};
  return Cleaner(mesh, options, space, progress).run();
}

std::vector<std::uint64_t> unused_after(const ValuedMesh& mesh, const MeshEdits& edits, const Progress& progress) {
  std::vector<bool> before, after;
  const auto use = [](std::vector<bool>& used, std::uint64_t v) {
    if (v >= used.size()) used.resize(std::max<std::uint64_t>(v + 1, 2 * used.size()), false);
    used[v] = true;
  };
  std::uint64_t place = 0;
  auto removed = edits.removed.begin();
  mesh.read([&](const MeshBatch& batch, std::span<const std::vector<double>>, std::uint64_t done, std::uint64_t total) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}})
      for (const VertexId v : batch.simplices[k]) use(after, v.value());
    const auto& corners = batch.triangles();
    for (std::size_t i = 0; i < corners.size(); i += 3, ++place) {
      const bool stays = removed == edits.removed.end() || *removed != place;
      if (!stays) ++removed;
      for (std::size_t k = 0; k < 3; ++k) use(stays ? after : before, corners[i + k].value());
    }
    progress(done, total);
  });
  for (const auto& corners : edits.triangles)
    for (const VertexRef& corner : corners)
      if (!corner.is_new) use(after, corner.number);
  std::vector<std::uint64_t> unused;
  for (std::uint64_t v = 0; v < before.size(); ++v)
    if (before[v] && (v >= after.size() || !after[v])) unused.push_back(v);
  return unused;
}

}  // namespace reeb::tools
