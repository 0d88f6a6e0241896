#include "libreeb/grid/box_sweep.h"

namespace reeb {

void BoxSweep::run(const Chunk& chunk, std::span<const double> values, Fragment& fragment,
                   const SweepOptions& options) {
  ranks_.sort(values, chunk.ids);
  tree_.build(chunk.box, ranks_.order());
  keep_.assign(chunk.vertex_count(), TreeSweep::kIfNotRegular);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true})
      if ((chunk.shared_faces & (high ? high_face(axis) : low_face(axis))) != 0)
        tree_.for_each_extremum_of_face(axis, high, [&](std::uint32_t v) { keep_[v] = TreeSweep::kAlways; });
  const SweptChunk swept{chunk, values, ranks_.order(), nullptr};
  sweep_.run(swept, tree_, keep_, options);
  sweep_.finish(swept, fragment);
}

std::size_t BoxSweep::memory_bytes() const {
  return ranks_.memory_bytes() + tree_.memory_bytes() + sweep_.memory_bytes() + keep_.capacity();
}

}  // namespace reeb
