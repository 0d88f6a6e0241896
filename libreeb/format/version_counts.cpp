#include "libreeb/format/version_counts.h"

#include <algorithm>

namespace reeb {
namespace {

// Changes from one version to the next, added up at the end. They are unsigned, so that negative ones wrap.
class Changes {
 public:
  explicit Changes(std::size_t versions) : change_(versions + 1) {}
  void add(std::uint32_t born, std::uint32_t died, std::uint64_t amount) {
    change_[born] += amount;
    change_[std::min<std::size_t>(died, change_.size() - 1)] -= amount;
  }
  std::uint64_t operator[](std::size_t version) const { return change_[version]; }

 private:
  std::vector<std::uint64_t> change_;
};

// The records at each node.
struct Incidence {
  std::vector<std::uint64_t> offsets;
  std::vector<std::uint32_t> records;
};

Incidence incidence(std::uint32_t node_count, std::span<const ArcVersion> arcs) {
  Incidence result{std::vector<std::uint64_t>(node_count + std::size_t{1}),
                   std::vector<std::uint32_t>(2 * arcs.size())};
  for (const ArcVersion& arc : arcs)
    for (const NodeId end : {arc.lo, arc.hi}) ++result.offsets[end.value()];
  std::uint64_t sum = 0;
  for (std::uint64_t& offset : result.offsets) offset = sum += offset;
  // Each offset is the end of its node's records. Filling from there downwards turns it into the beginning.
  for (std::uint32_t i = 0; i < arcs.size(); ++i)
    for (const NodeId end : {arcs[i].lo, arcs[i].hi}) result.records[--result.offsets[end.value()]] = i;
  return result;
}

// Adds the versions in which any of these records lives.
void add_union(std::span<std::uint32_t> records, std::span<const ArcVersion> arcs, Changes& nodes) {
  std::sort(records.begin(), records.end(),
            [&](std::uint32_t a, std::uint32_t b) { return arcs[a].born < arcs[b].born; });
  std::uint32_t born = arcs[records[0]].born, died = arcs[records[0]].died;
  for (const std::uint32_t record : records.subspan(1)) {
    if (arcs[record].born > died) {
      nodes.add(born, died, 1);
      born = arcs[record].born;
    }
    died = std::max(died, arcs[record].died);
  }
  nodes.add(born, died, 1);
}

}  // namespace

std::vector<VersionCounts> count_versions(std::uint32_t node_count, std::span<const ArcVersion> arcs,
                                          std::span<const std::uint32_t> bucket_counts,
                                          std::span<const double> persistence) {
  const std::size_t versions = persistence.size() + 1;
  Changes node_changes(versions), arc_changes(versions), bucket_changes(versions);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    arc_changes.add(arcs[i].born, arcs[i].died, 1);
    if (!bucket_counts.empty()) bucket_changes.add(arcs[i].born, arcs[i].died, bucket_counts[i]);
  }
  Incidence at = incidence(node_count, arcs);
  for (std::uint32_t node = 0; node < node_count; ++node) {
    const auto first = at.offsets[node], last = at.offsets[node + 1];
    if (first == last)
      node_changes.add(0, kNeverDies, 1);
    else
      add_union(std::span(at.records).subspan(first, last - first), arcs, node_changes);
  }
  std::vector<VersionCounts> counts(versions);
  VersionCounts sum;
  for (std::size_t version = 0; version < versions; ++version) {
    sum.persistence = version == 0 ? 0.0 : persistence[version - 1];
    sum.nodes += node_changes[version];
    sum.arcs += arc_changes[version];
    sum.buckets += bucket_changes[version];
    counts[version] = sum;
  }
  return counts;
}

}  // namespace reeb
