// Makes an incoherent mesh coherent, on disk.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/chunks/last_use.h"
#include "ooc/chunks/spooled_mesh.h"

namespace reeb::ooc {

// The same mesh with its vertices numbered along a Hilbert curve through the bounding box, and its triangles sorted by
// their lowest vertex. to_original() returns the ids that the total order needs (docs/SEMANTICS.md, Order), so that the
// results are those of the original mesh.
class ReorderedMesh : public SpooledMesh {
 public:
  ReorderedMesh(const IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget, std::uint64_t allowance_bytes)
      : SpooledMesh(mesh.column_count(), temp, budget, allowance_bytes / 4 * 3),
        originals_("original ids", temp, budget, allowance_bytes / 4, 0),
        number_count_(mesh.number_count()) {}

  void to_original(std::span<VertexId> ids) override {
    for (VertexId& id : ids) id = VertexId(originals_.get(id.value()));
  }
  std::uint64_t number_count() const override { return number_count_; }
  // Of consecutive vertices.
  void set_originals(std::uint64_t first, std::span<const std::uint64_t> originals) {
    originals_.write(first, originals);
  }

 private:
  PagedTable<std::uint64_t> originals_;
  std::uint64_t number_count_;
};

struct ReorderOptions {
  std::uint64_t allowance_bytes = 32 << 20;  // of the budget, while reorder() runs
  unsigned coordinates = 3;                  // the number of leading columns that are coordinates; at most 3 are used
  unsigned threads = 1;                      // that sort; with two or more, two look up vertices
  // Along one curve for each of some slabs across the longest axis: the front is shorter, but triangles are less near.
  bool in_slabs = false;
  // The part that is done, from 0 to 1. Called often, by one thread at a time. It may throw to stop.
  std::function<void(double)> progress = {};
};

// Reads the triangles of `mesh` once, and its vertices in order twice; once more for each column with values that are
// not float32, and for each after the third. Partitioning and sorting replace all random access.
//
// THROWS: what reading the mesh throws; Error{kResource} of the budget or the disk.
// MEMORY: the allowance; the result keeps a quarter of it. About 45 bytes of disk per triangle.   TIME: O(n log n).
std::unique_ptr<ReorderedMesh> reorder(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                       const ReorderOptions& options = {});

struct SortedMesh {
  std::unique_ptr<ReorderedMesh> mesh;
  LastUse uses;
};

// The same with the last uses of the vertices, which are found while the triangles are stored: that takes a fraction of
// the time of a scan. MEMORY: the allowance of `uses`, and 4 bytes for each of its blocks, in addition.
// REQUIRES: `uses` does not allow giving up, and has no progress.
SortedMesh reorder_with_last_uses(IndexedMesh& mesh, const io::TempDir& temp, MemoryBudget& budget,
                                  const ReorderOptions& options, const LastUseOptions& uses);

}  // namespace reeb::ooc
