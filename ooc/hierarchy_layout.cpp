#include "ooc/hierarchy_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>

#include "libreeb/format/version_counts.h"
#include "ooc/frame_size.h"

namespace reeb::ooc {
namespace {

// Arcs that never die first. The order is total up to records that are equal in every field, whose
// buckets keep the order of the input.
std::vector<std::uint32_t> storage_order(const std::vector<ArcVersion>& arcs) {
  std::vector<std::uint32_t> order(arcs.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const ArcVersion& arc = arcs[i];
    return std::tuple(kNeverDies - arc.died, arc.lo, arc.hi, arc.born, i);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

// Cuts the sequence "isolated nodes, then records" where a frame is full.
class FrameCutter {
 public:
  FrameCutter(const std::vector<ArcVersion>& arcs, const ArcBucketsView& buckets, std::uint32_t steps,
              std::size_t node_count, HierarchyLayout& layout)
      : arcs_(arcs), buckets_(buckets), complete_(steps + 1), seen_(node_count), layout_(layout) {}

  void run() {
    std::size_t isolated = 0, record = 0;
    for (; isolated < layout_.isolated.size(); ++isolated)
      if ((cost_ += kNodeCost) >= kFrameTargetBytes) cut(isolated + 1, 0);
    for (; record < layout_.order.size(); ++record)
      if ((cost_ += record_cost(layout_.order[record])) >= kFrameTargetBytes) cut(isolated, record + 1);
    const bool ends_here = !layout_.cuts.empty() && layout_.cuts.back().finest == 0;
    if (!ends_here) cut(isolated, record);
  }

 private:
  std::size_t record_cost(std::uint32_t record) {
    const ArcVersion& arc = arcs_[record];
    std::size_t cost = kArcCost + kBucketCost * buckets_.count(record);
    for (const NodeId end : {arc.lo, arc.hi}) {
      if (!seen_[end.value()]) cost += kNodeCost;
      seen_[end.value()] = true;
    }
    if (arc.died < last_died_ && last_died_ != kNeverDies) cost += kVersionCost * (last_died_ - arc.died);
    last_died_ = arc.died;
    return cost;
  }

  // The records that follow die with some version or before: all coarser ones are complete.
  void cut(std::size_t isolated_end, std::size_t record_end) {
    const bool all = isolated_end == layout_.isolated.size() && record_end == layout_.order.size();
    if (all) complete_ = 0;
    else if (isolated_end == layout_.isolated.size())
      complete_ = std::min(complete_, arcs_[layout_.order[record_end]].died);
    layout_.cuts.push_back({isolated_end, record_end, complete_});
    cost_ = 0;
  }

  const std::vector<ArcVersion>& arcs_;
  const ArcBucketsView& buckets_;
  std::uint32_t complete_;
  std::uint32_t last_died_ = kNeverDies;
  std::vector<bool> seen_;
  std::size_t cost_ = 0;
  HierarchyLayout& layout_;
};

// Whether a threshold yields exactly this version: the next cancellation has another persistence.
bool has_threshold(const std::vector<VersionCounts>& versions, std::size_t version) {
  return version == 0 || version + 1 == versions.size() ||
         versions[version + 1].persistence > versions[version].persistence;
}

// The versions worth a line: where frames end, and wherever the nodes have about doubled; each
// moved towards the coarse to one that a threshold can name.
std::vector<std::uint32_t> table_versions(const HierarchyLayout& layout, std::uint32_t steps) {
  const auto& versions = layout.versions;
  std::vector<std::uint32_t> result{0, steps};
  for (const FrameCut& cut : layout.cuts)
    if (cut.finest <= steps) result.push_back(cut.finest);
  std::uint64_t nodes = std::max<std::uint64_t>(1, versions[steps].nodes);
  for (std::uint32_t version = steps; version > 0; --version) {
    if (versions[version - 1].nodes < 2 * nodes) continue;
    result.push_back(version);
    nodes = versions[version - 1].nodes;
  }
  for (std::uint32_t& version : result)
    while (!has_threshold(versions, version)) ++version;
  std::sort(result.begin(), result.end(), std::greater<>());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

std::vector<LevelLine> level_table(const HierarchyLayout& layout, std::uint32_t steps) {
  std::vector<LevelLine> levels;
  std::uint32_t frame = 0;
  for (const std::uint32_t version : table_versions(layout, steps)) {
    while (layout.cuts[frame].finest > version) ++frame;
    const VersionCounts& counts = layout.versions[version];
    levels.push_back({.version = version,
                      .frames = frame + 1,
                      .threshold = level_threshold(version, counts.persistence),
                      .nodes = counts.nodes,
                      .arcs = counts.arcs,
                      .buckets = counts.buckets,
                      .file_bytes = 0,
                      .memory_bytes = level_memory(counts.nodes, counts.arcs, counts.buckets)});
  }
  return levels;
}

}  // namespace

HierarchyLayout lay_out(const ReebGraph& graph, const Hierarchy& hierarchy, const ArcBucketsView& buckets) {
  HierarchyLayout layout;
  const auto steps = static_cast<std::uint32_t>(hierarchy.persistence.size());
  const auto node_count = static_cast<std::uint32_t>(graph.node_count());
  layout.order = storage_order(hierarchy.arcs);

  std::vector<bool> touched(node_count);
  for (const ArcVersion& arc : hierarchy.arcs) touched[arc.lo.value()] = touched[arc.hi.value()] = true;
  for (std::uint32_t node = 0; node < node_count; ++node)
    if (!touched[node]) layout.isolated.push_back(node);

  std::vector<std::uint32_t> bucket_counts;
  if (!buckets.empty())
    for (std::size_t i = 0; i < hierarchy.arcs.size(); ++i)
      bucket_counts.push_back(static_cast<std::uint32_t>(buckets.count(i)));
  layout.versions = count_versions(node_count, hierarchy.arcs, bucket_counts, hierarchy.persistence);
  FrameCutter(hierarchy.arcs, buckets, steps, node_count, layout).run();
  layout.levels = level_table(layout, steps);
  return layout;
}

void check_hierarchy(const ReebGraph& graph, const Hierarchy& hierarchy, const ArcBucketsView& buckets) {
  const auto fail = [](const char* what, std::size_t i, const char* why) {
    throw std::logic_error(std::string("Hierarchy: ") + what + " " + std::to_string(i) + " " + why);
  };
  const std::size_t nodes = graph.node_count(), steps = hierarchy.persistence.size();
  if (steps >= kNeverDies - 1) fail("step", steps, "is one too many");
  for (std::size_t i = 0; i < steps; ++i)
    if (!(hierarchy.persistence[i] >= (i == 0 ? 0.0 : hierarchy.persistence[i - 1])))
      fail("step", i + 1, "has a smaller persistence than the one before");
  for (std::size_t i = 0; i < hierarchy.arcs.size(); ++i) {
    const ArcVersion& arc = hierarchy.arcs[i];
    if (!(arc.lo < arc.hi) || arc.hi.value() >= nodes) fail("arc", i, "does not go up to a node");
    if (arc.born >= arc.died || (arc.died > steps && arc.died != kNeverDies))
      fail("arc", i, "does not live between two versions");
  }
  for (std::size_t i = 0; i < hierarchy.pairs.size(); ++i)
    if (hierarchy.pairs[i].hi < hierarchy.pairs[i].lo || hierarchy.pairs[i].hi.value() >= nodes)
      fail("pair", i, "does not go up to a node");
  if (!buckets.empty() && buckets.offsets.size() != hierarchy.arcs.size() + 1)
    fail("arc", hierarchy.arcs.size(), "has no buckets");
}

}  // namespace reeb::ooc
