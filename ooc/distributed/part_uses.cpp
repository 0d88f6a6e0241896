#include "ooc/distributed/part_uses.h"

#include <algorithm>

namespace reeb::ooc {

PartSpan PartUses::span_of(UseEntry entry) const {
  const std::uint64_t block = uses_.summary().block_triangles;
  const bool known = entry.span() != UseEntry::kSaturatedSpan;
  const std::uint64_t first = known ? entry.last_block() - entry.span() : 0;
  return {shares_.part_of(first * block), shares_.part_of((entry.last_block() + std::uint64_t{1}) * block - 1)};
}

void PartUses::find(std::span<const VertexId> ids, std::uint32_t part, std::vector<PartSpan>& spans) {
  entries_.resize(ids.size());
  uses_.lookup(ids, entries_);
  spans.resize(ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const UseEntry entry(entries_[i]);
    if (entry.unused()) throw if_wrong_;
    spans[i] = span_of(entry);
    if (part < spans[i].first || part > spans[i].last) throw if_wrong_;
  }
}

bool PartUses::find_unused(std::uint64_t& first, std::uint64_t end, std::size_t limit, std::vector<VertexId>& ids) {
  ids.clear();
  while (ids.size() < limit && first < end) {
    entries_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(limit - ids.size(), end - first)));
    uses_.read(VertexId(first), entries_);
    for (std::size_t i = 0; i < entries_.size(); ++i)
      if (UseEntry(entries_[i]).unused()) ids.push_back(VertexId(first + i));
    first += entries_.size();
  }
  return !ids.empty();
}

}  // namespace reeb::ooc
