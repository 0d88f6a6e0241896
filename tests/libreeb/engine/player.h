// Streams a complex to the on-line engine, as a user would.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "libreeb/engine/online_reeb.h"
#include "tests/support/inputs/complex.h"
#include "tests/support/random.h"

namespace reeb::test {

// When vertices are finalized: never, as soon as no later simplex names them, some time later, or every other one
// never.
enum class Finalization { kNever, kAtOnce, kLater, kPartly };

// Adds a complex in its order. Vertices come when a simplex first needs them or, at random, before. After each simplex,
// `step` is called with the numbers of vertices and simplices added so far.
class Player {
 public:
  using Step = std::function<void(std::size_t vertices, std::size_t simplices)>;

  Player(const Complex& complex, Finalization finalization, std::uint64_t seed)
      : complex_(complex), finalization_(finalization), random_(seed) {
    if (finalization_ == Finalization::kNever) return;
    last_use_.assign(complex.vertex_count(), 0);
    for (std::size_t i = 0; i < complex.simplices.size(); ++i)
      for (const std::uint64_t corner : complex.simplices[i]) last_use_[corner] = i;
  }

  void play(OnlineReeb& engine, const Step& step = {}) {
    for (std::size_t i = 0; i < complex_.simplices.size(); ++i) {
      const auto& simplex = complex_.simplices[i];
      add_vertices(engine, *std::max_element(simplex.begin(), simplex.end()) + 1);
      if (random_.chance(10)) add_vertices(engine, complex_.vertex_count());
      engine.add_simplex(std::vector<VertexId>(simplex.begin(), simplex.end()));
      finalize_some(engine, i);
      if (step) step(added_, i + 1);
    }
    add_vertices(engine, complex_.vertex_count());
    if (!complex_.simplices.empty()) finalize_some(engine, complex_.simplices.size() - 1);
  }

 private:
  void add_vertices(OnlineReeb& engine, std::size_t count) {
    for (; added_ < count; ++added_) {
      const VertexId id = engine.add_vertex(complex_.values[added_], complex_.positions[added_]);
      ASSERT_EQ(id, VertexId(added_));
      waiting_.push_back(added_);
    }
  }

  // Finalizes, in random order, vertices that no simplex after this one names.
  void finalize_some(OnlineReeb& engine, std::size_t simplex) {
    if (finalization_ == Finalization::kNever) return;
    const unsigned percent = finalization_ == Finalization::kLater ? 30 : 100;
    random_.shuffle(waiting_);
    std::erase_if(waiting_, [&](std::size_t v) {
      if (last_use_[v] > simplex || !random_.chance(percent)) return false;
      if (finalization_ == Finalization::kPartly && random_.chance(50)) return true;
      engine.finalize(VertexId(v));
      return true;
    });
  }

  const Complex& complex_;
  Finalization finalization_;
  Random random_;
  std::vector<std::size_t> last_use_, waiting_;
  std::size_t added_ = 0;
};

inline Finalization any_finalization(Random& random) { return static_cast<Finalization>(random.below(4)); }

// Sweeps batches of this number of triangles. At random, triangles wait for final vertices, some of them, or none.
inline OnlineReeb::Options any_waiting(std::size_t batch, Random& random) {
  OnlineReeb::Options options{.batch_triangles = batch};
  if (random.chance(70)) options.waiting_triangles = random.chance(60) ? 0 : random.below(30);
  return options;
}

}  // namespace reeb::test
