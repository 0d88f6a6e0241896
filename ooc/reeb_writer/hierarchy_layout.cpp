#include "ooc/reeb_writer/hierarchy_layout.h"

#include <algorithm>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "libreeb/base/prefetch.h"
#include "ooc/reeb_writer/frame_size.h"
#include "ooc/reeb_writer/version_counter.h"
#include "ooc/threads/read_ahead.h"

namespace reeb::ooc {
namespace {

[[noreturn]] void fail(const char* what, std::uint64_t i, const char* why) {
  throw std::logic_error(std::string("Hierarchy: ") + what + " " + std::to_string(i) + " " + why);
}

// Cuts the sequence "isolated nodes, then records" where a frame is full.
class FrameCutter {
 public:
  FrameCutter(std::uint32_t steps, std::vector<FrameCut>& cuts) : complete_(steps + 1), cuts_(cuts) {}

  // Both return the frame of what was added.
  std::uint32_t add_isolated() {
    settle(complete_);
    ++isolated_;
    return add(kNodeCost);
  }
  std::uint32_t add_record(std::uint32_t died, std::uint64_t new_nodes, std::uint64_t buckets) {
    // The records that follow die with this version or a finer one: all coarser versions are complete.
    settle(std::min(complete_, died));
    ++records_;
    std::uint64_t cost = kArcCost + kNodeCost * new_nodes + kBucketCost * buckets;
    if (died < last_died_ && last_died_ != kNeverDies) cost += kVersionCost * (last_died_ - died);
    last_died_ = died;
    return add(cost);
  }
  void finish() {
    if (!is_cut_) cuts_.push_back({isolated_, records_, 0});
    settle(0);
  }

 private:
  std::uint32_t add(std::uint64_t cost) {
    const auto frame = static_cast<std::uint32_t>(cuts_.size());
    if ((cost_ += cost) >= kFrameTargetBytes) {
      cuts_.push_back({isolated_, records_, 0});
      is_cut_ = true;
      cost_ = 0;
    }
    return frame;
  }
  // The record after a cut determines which versions the cut completes.
  void settle(std::uint32_t complete) {
    if (!std::exchange(is_cut_, false)) return;
    cuts_.back().finest = complete_ = complete;
  }

  std::uint32_t complete_;
  std::uint32_t last_died_ = kNeverDies;
  std::uint64_t cost_ = 0, records_ = 0;
  std::size_t isolated_ = 0;
  bool is_cut_ = false;  // the last cut is at the end of what was added so far
  std::vector<FrameCut>& cuts_;
};

// Whether a threshold yields exactly this version: the next cancellation has another persistence.
bool has_threshold(const std::vector<VersionCounts>& versions, std::size_t version) {
  return version == 0 || version + 1 == versions.size() ||
         versions[version + 1].persistence > versions[version].persistence;
}

// The versions that get a line: at the ends of frames, and wherever the number of nodes has about doubled. Each is
// moved to the next coarser one that a threshold yields.
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

void check_steps(std::span<const double> persistence) {
  if (persistence.size() >= kNeverDies - 1) fail("step", persistence.size(), "is one too many");
  for (std::size_t i = 0; i < persistence.size(); ++i)
    if (!(persistence[i] >= (i == 0 ? 0.0 : persistence[i - 1])))
      fail("step", i + 1, "has a smaller persistence than the one before");
}

void check_record(const ArcVersion& arc, std::uint64_t i, std::size_t nodes, std::size_t steps) {
  if (!(arc.lo < arc.hi) || arc.hi.value() >= nodes) fail("arc", i, "does not go up to a node");
  if (arc.born >= arc.died || arc.born > steps || (arc.died > steps && arc.died != kNeverDies))
    fail("arc", i, "does not live between two versions");
}

void check_pairs(HierarchySource& hierarchy) {
  hierarchy.rewind_pairs();
  PersistencePair pair;
  for (std::uint64_t i = 0; hierarchy.next_pair(pair); ++i)
    if (pair.hi < pair.lo || pair.hi.value() >= hierarchy.node_count()) fail("pair", i, "does not go up to a node");
}

// Reads and checks records, finds their frames, and tells which frame introduces each node.
class FramePlanner {
 public:
  FramePlanner(HierarchySource& hierarchy, RecordSource& records, std::vector<FrameCut>& cuts)
      : hierarchy_(hierarchy),
        records_(records),
        steps_(static_cast<std::uint32_t>(hierarchy.persistence().size())),
        node_count_(hierarchy.node_count()),
        introduced_(node_count_ / kBits + 1),
        cutter_(steps_, cuts) {
    records_.rewind(RecordSource::Buckets::kOnlyCounted);
  }

  // To be called for all isolated nodes first.
  void add_isolated(NodeId node) {
    mark(node);
    hierarchy_.introduce(node, cutter_.add_isolated());
  }

  // The next records. False at the end.
  bool read(std::vector<CountedArc>& some) {
    constexpr std::size_t kRecordsAtOnce = 512;
    some.clear();
    for (PackedRecord record; some.size() < kRecordsAtOnce && records_.next(record); ++count_) {
      const ArcVersion& arc = record.arc;
      check_record(arc, count_, node_count_, steps_);
      if (arc.died > std::exchange(last_died_, arc.died)) fail("arc", count_, "lives longer than the one before");
      some.push_back({arc, record.bucket_count});
      // Nodes can be anywhere in memory, so without this place() would wait for each.
      for (const NodeId end : {arc.lo, arc.hi}) prefetch(&introduced_[end.value() / kBits]);
    }
    for (const CountedArc& record : some) place(record);
    return !some.empty();
  }

  // REQUIRES: read() has returned false. Returns the number of records.
  std::uint64_t finish() {
    for (std::uint32_t node = 0; node < node_count_; ++node)
      if (mark(NodeId(node))) fail("node", node, "is neither isolated nor named by an arc");
    cutter_.finish();
    return count_;
  }

 private:
  static constexpr std::uint32_t kBits = 64;

  // Marks the node as introduced. Returns whether it was not before.
  bool mark(NodeId node) {
    std::uint64_t& bits = introduced_[node.value() / kBits];
    const std::uint64_t bit = std::uint64_t{1} << node.value() % kBits;
    return (std::exchange(bits, bits | bit) & bit) == 0;
  }

  void place(const CountedArc& record) {
    const NodeId lo = record.arc.lo, hi = record.arc.hi;
    const bool is_new_lo = mark(lo), is_new_hi = mark(hi);
    const std::uint32_t new_nodes = (is_new_lo ? 1u : 0u) + (is_new_hi ? 1u : 0u);
    const std::uint32_t frame = cutter_.add_record(record.arc.died, new_nodes, record.buckets);
    if (is_new_lo) hierarchy_.introduce(lo, frame);
    if (is_new_hi) hierarchy_.introduce(hi, frame);
  }

  HierarchySource& hierarchy_;
  RecordSource& records_;
  const std::uint32_t steps_;
  const std::size_t node_count_;
  std::vector<std::uint64_t> introduced_;  // a bit for each node
  FrameCutter cutter_;
  std::uint32_t last_died_ = kNeverDies;
  std::uint64_t count_ = 0;
};

}  // namespace

HierarchyLayout lay_out(HierarchySource& hierarchy, RecordSource& records, bool background) {
  const std::size_t node_count = hierarchy.node_count(), steps = hierarchy.persistence().size();
  check_steps(hierarchy.persistence());
  check_pairs(hierarchy);
  HierarchyLayout layout;
  {
    VersionCounter counter(node_count, steps + 1);
    FramePlanner planner(hierarchy, records, layout.cuts);
    const std::span<const NodeId> isolated = hierarchy.isolated();
    for (std::size_t i = 0; i < isolated.size(); ++i) {
      if (isolated[i].value() >= node_count || (i > 0 && !(isolated[i - 1] < isolated[i])))
        fail("isolated node", i, "is not above the one before it");
      counter.add_isolated(isolated[i]);
      planner.add_isolated(isolated[i]);
    }
    read_ahead<std::vector<CountedArc>>(
        background, [&](auto& some) { return planner.read(some); }, [&](const auto& some) { counter.add(some); });
    layout.records = planner.finish();
    layout.versions = counter.take(hierarchy.persistence());
  }
  layout.levels = level_table(layout, static_cast<std::uint32_t>(steps));
  return layout;
}

}  // namespace reeb::ooc
