// Which shares of a mesh name each of its vertices.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "libreeb/base/ids.h"
#include "libreeb/parts/part_set.h"
#include "ooc/chunks/last_use.h"
#include "ooc/distributed/mesh_share.h"

namespace reeb::ooc {

// A table of last uses, with blocks of any size, read as a table of shares: a block that two shares divide counts for
// both.
class PartUses {
 public:
  // `if_wrong` is thrown where a share names a vertex, but not by this table.
  PartUses(LastUse uses, const Shares& shares, Error if_wrong = input_changed())
      : uses_(std::move(uses)), shares_(shares), if_wrong_(std::move(if_wrong)) {}

  const Shares& shares() const { return shares_; }
  // spans[i] is that of ids[i]. REQUIRES: this share names each of them.
  // THROWS: `if_wrong`, if the table says otherwise.
  void find(std::span<const VertexId> ids, std::uint32_t part, std::vector<PartSpan>& spans);
  // Replaces `ids` by the next vertices from `first` to before `end` that no share names, at most `limit`, and moves
  // `first` on. False at the end.
  bool find_unused(std::uint64_t& first, std::uint64_t end, std::size_t limit, std::vector<VertexId>& ids);

 private:
  PartSpan span_of(UseEntry entry) const;

  LastUse uses_;
  Shares shares_;
  Error if_wrong_;
  std::vector<std::uint32_t> entries_;
};

}  // namespace reeb::ooc
