// Which shares of a mesh name each of its vertices.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/ids.h"
#include "libreeb/parts/part_set.h"
#include "ooc/chunks/last_use.h"
#include "ooc/distributed/mesh_share.h"

namespace reeb::ooc {

// A table of last uses, with blocks of any size, read as a table of shares: a block that two shares divide counts for
// both.
class PartUses {
 public:
  PartUses(LastUse uses, const Shares& shares) : uses_(std::move(uses)), shares_(shares) {}

  const Shares& shares() const { return shares_; }
  // spans[i] is that of ids[i]. REQUIRES: each is named by a share.
  void find(std::span<const VertexId> ids, std::vector<PartSpan>& spans);
  // Replaces `ids` by the next vertices from `first` to before `end` that no share names, at most `limit`, and moves
  // `first` on. False at the end.
  bool find_unused(std::uint64_t& first, std::uint64_t end, std::size_t limit, std::vector<VertexId>& ids);

 private:
  PartSpan span_of(UseEntry entry) const;

  LastUse uses_;
  Shares shares_;
  std::vector<std::uint32_t> entries_;
};

}  // namespace reeb::ooc
