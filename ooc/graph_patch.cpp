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
  return arc_ < patch_.graph.arc_count() && (stored == nullptr || !(*stored < keys(arc_)));
}

void PatchReader::take(ArcPiece& piece) {
  piece.arcs.push_back(keys(arc_));
  if (!piece.buckets.offsets.empty()) {
    const auto own = patch_.buckets.view().of(arc_);
    piece.buckets.buckets.insert(piece.buckets.buckets.end(), own.begin(), own.end());
    piece.buckets.offsets.push_back(piece.buckets.buckets.size());
  }
  ++arc_;
}

}  // namespace reeb::ooc
