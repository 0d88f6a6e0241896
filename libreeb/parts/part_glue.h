// Glues shares of a mesh, in any order and grouping (docs/ARCHITECTURE.md, Shares of a mesh).
//
// A vertex is complete as soon as every share from the first to the last that names it is in. Then its paths are
// dropped, and what cannot change any more goes to the sink. What remains can be glued again, with the shares that are
// missing.
//
// TIME: O(shares), and the steps of the zips. MEMORY: proportional to the fronts between what is in and what is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libreeb/containers/flat_map.h"
#include "libreeb/engine/glue.h"
#include "libreeb/parts/open_part.h"

namespace reeb {

class PartGlue {
 public:
  // `options` are those of all that is added: no share may have used a larger threshold or exponent. Without an
  // exponent, buckets are left out.
  PartGlue(GraphSink& sink, std::uint32_t parts, const SweepOptions& options)
      : glue_(sink, true), options_(options), have_(parts) {}

  // Adds the shares in `runs`, which together left `part`. It is changed.
  // REQUIRES: none of them was added before; check_open_part() holds.
  // THROWS: Error{kChanged} if a vertex has another value, or is said to be named elsewhere, than in the shares so far.
  void add(OpenPart& part, const std::vector<PartSpan>& runs);

  const PartSet& parts() const { return have_; }
  // Replaces `part` by what other shares can still change. Empty if all are in.
  // THROWS: Error{kResource} if it is too large for a fragment.
  void copy_open(OpenPart& part) const;
  // What that takes. O(live graph)
  std::size_t copy_bytes() const;
  std::uint64_t removed_pairs() const { return glue_.removed_pairs(); }  // as noise, in the shares and here
  const Glue& glue() const { return glue_; }
  std::size_t memory_bytes() const;
  // The most that adding this can make of it, with the part itself.
  std::size_t memory_bytes_with(const OpenPart& part) const;

 private:
  struct OpenVertex {
    VertexId vertex;
    PartSpan span;
  };

  void merge_spans(OpenPart& part) const;
  void mark_uses(OpenPart& part);
  void sort_steps(Fragment& live);
  void remember(const OpenPart& part);
  void complete_others();

  Glue glue_;
  SweepOptions options_;
  PartSet have_;
  FlatMap open_of_;               // the vertices that are not complete,
  std::vector<OpenVertex> open_;  // and their spans
  std::vector<std::uint32_t> edge_order_, last_place_;
};

}  // namespace reeb
