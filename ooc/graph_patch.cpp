#include "ooc/graph_patch.h"

#include <utility>

namespace reeb::ooc {
namespace {

// Whether `key` is in the list, from `at` on, which moves on to it.
bool is_next(const std::vector<SweepKey>& list, std::size_t& at, const SweepKey& key) {
  while (at < list.size() && list[at] < key) ++at;
  return at < list.size() && list[at] == key;
}

}  // namespace

PatchReader::PatchReader(GraphPatch patch) : patch_(std::move(patch)), table_(patch_.redone) {}

bool PatchReader::drops(const SweepKey& node) { return is_next(patch_.gone, gone_, node); }

bool PatchReader::drops(const ArcKeys& arc) {
  return is_next(patch_.redone, redone_, arc.lo) || table_.find(arc.hi) != NodeTable::kNone;
}

bool PatchReader::comes_before(const ArcKeys* stored) const {
  const auto& arcs = patch_.arcs.records;
  return arc_ < arcs.size() && (stored == nullptr || !(*stored < arcs[arc_].keys));
}

}  // namespace reeb::ooc
