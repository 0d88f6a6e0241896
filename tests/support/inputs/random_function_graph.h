// The Reeb graph of a random function on a square grid, with its embedding: most of it is noise of
// every size, and monotone paths are long.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "io/file/temp_dir.h"
#include "libreeb/base/memory_budget.h"
#include "libreeb/engine/online_reeb.h"
#include "ooc/stored_graph/load_graph.h"
#include "ooc/stored_graph/segment_store.h"

namespace reeb::bench {

// A graph of about this number of arcs. At least `buckets` buckets span the range; their exponent is returned too.
inline ooc::LoadedGraph make_random_function_graph(std::size_t arcs, std::uint32_t buckets, int& exponent,
                                                   const io::TempDir& temp, MemoryBudget& budget) {
  constexpr double kArcsPerVertex = 0.557;
  const auto width = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(arcs) / kArcsPerVertex)) + 2;
  ooc::SegmentStore store(temp, budget);
  OnlineReeb reeb({.buckets = buckets}, &store);
  std::mt19937_64 random(1);
  for (std::uint64_t y = 0; y < width; ++y) {
    for (std::uint64_t x = 0; x < width; ++x)
      reeb.add_vertex(static_cast<double>(random() >> 11) * 0x1p-53,
                      {static_cast<double>(x), static_cast<double>(y), 0});
    for (std::uint64_t x = 0; y > 0 && x + 1 < width; ++x) {
      const VertexId a(y * width - width + x), b(a.value() + 1), c(a.value() + width), d(c.value() + 1);
      reeb.add_simplex(std::array{a, b, d});
      reeb.add_simplex(std::array{a, d, c});
    }
    for (std::uint64_t x = 0; y > 0 && x < width; ++x) reeb.finalize(VertexId((y - 1) * width + x));
  }
  reeb.finish();
  store.finish();
  exponent = bucket_exponent(0, 1, buckets);
  return ooc::read_graph(store, {.bucket_exponent = exponent});
}

}  // namespace reeb::bench
