// Chains of beads against lists of keys; and what they are for: many bumps along a border.
#include "libreeb/engine/bead_chains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "libreeb/engine/glue.h"
#include "libreeb/sweep/chunk_sweep.h"
#include "tests/libreeb/engine/streamed_mesh.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

// Chains beside lists of the same keys, both from above.
class Chains {
 public:
  explicit Chains(std::uint64_t seed) : random_(seed) {}

  void step() {
    switch (random_.below(5)) {
      case 0:
        add_one();
        break;
      case 1:
        join_two();
        break;
      case 2:
        move_some();
        break;
      case 3:
        drop_lowest();
        break;
      default:
        drop_all();
    }
  }

  void compare() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < chains_.size(); ++i) {
      std::vector<SweepKey> keys;
      beads_.visit(chains_[i], [&](BeadChains::Index bead) {
        keys.push_back(beads_.key(bead));
        EXPECT_EQ(beads_.position(bead)[0], beads_.key(bead).value);
      });
      EXPECT_EQ(keys, lists_[i]);
      EXPECT_EQ(chains_[i].empty(), keys.empty());
      if (!keys.empty()) {
        EXPECT_EQ(beads_.key(chains_[i].lowest), keys.back());
      }
      count += keys.size();
    }
    EXPECT_EQ(beads_.used(), count);
  }

 private:
  // Below all beads so far.
  void add_one() {
    const SweepKey key{next_--, VertexId(3)};
    const BeadChains::Chain bead = beads_.make(key, {key.value, 0, 0}, {});
    if (chains_.empty() || random_.chance(30)) {
      chains_.push_back(bead);
      lists_.push_back({key});
      return;
    }
    const std::size_t i = any();
    chains_[i] = beads_.joined(chains_[i], bead);
    lists_[i].push_back(key);
  }
  // A chain is joined to what comes below it.
  void join_two() {
    if (chains_.size() < 2) return;
    const std::size_t a = any(), b = any();
    if (a == b) return;
    chains_[a] = beads_.joined(chains_[a], chains_[b]);
    lists_[a].insert(lists_[a].end(), lists_[b].begin(), lists_[b].end());
    remove(b);
  }
  // The highest beads of one chain are moved to the end of another, one by one.
  void move_some() {
    if (chains_.size() < 2) return;
    const std::size_t a = any(), b = any();
    if (a == b) return;
    BeadChains::Index next = beads_.highest(chains_[b]);
    for (std::uint64_t count = random_.below(4); count > 0 && next != BeadChains::kNone; --count) {
      const BeadChains::Index bead = next;
      next = beads_.below(chains_[b], bead);
      beads_.append(chains_[a], bead);
      lists_[a].push_back(lists_[b].front());
      lists_[b].erase(lists_[b].begin());
    }
    chains_[b] = beads_.from(chains_[b], next);
  }
  void drop_lowest() {
    if (chains_.empty()) return;
    const std::size_t i = any();
    if (chains_[i].empty()) return;
    const BeadChains::Index lowest = chains_[i].lowest;
    chains_[i] = beads_.without_lowest(chains_[i]);
    beads_.free(lowest);
    lists_[i].pop_back();
  }
  void drop_all() {
    if (chains_.size() < 5) return;
    const std::size_t i = any();
    beads_.visit(chains_[i], [&](BeadChains::Index bead) { beads_.free(bead); });
    remove(i);
  }

  std::size_t any() { return random_.below(chains_.size()); }
  void remove(std::size_t i) {
    chains_.erase(chains_.begin() + static_cast<std::ptrdiff_t>(i));
    lists_.erase(lists_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  Random random_;
  double next_ = 0;
  BeadChains beads_{true};
  std::vector<BeadChains::Chain> chains_;
  std::vector<std::vector<SweepKey>> lists_;
};

TEST(BeadChains, AreListsOfKeys) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Chains chains(seed);
    for (int step = 0; step < 2000; ++step) {
      chains.step();
      if (step % 10 == 0) chains.compare();
      if (testing::Test::HasFailure()) return;
    }
  }
}

// A slope of `width` by `length` cells, whose value grows along a row, with a bump in every fourth cell of the first
// `bumpy` rows. It comes row by row. So when half of it is there, every bump of it is a fork on the way from the low
// end of the border to the high one, and later rows can still tell nothing about the rest of the slope.
Mesh slope_with_bumps(std::size_t width, std::size_t length, std::size_t bumpy) {
  Mesh mesh;
  Random random(1);
  for (std::size_t y = 0; y <= length; ++y)
    for (std::size_t x = 0; x <= width; ++x) {
      const bool is_bump = x % 2 == 1 && y % 2 == 1 && y < bumpy;
      mesh.values.push_back(static_cast<double>(x) + (is_bump ? 3 : 0) + 0.1 * random.unit());
      mesh.positions.push_back({static_cast<double>(x), static_cast<double>(y), 0});
    }
  for (std::size_t y = 0; y < length; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const VertexId a(y * (width + 1) + x), b(a.value() + 1), c(a.value() + width + 1), d(c.value() + 1);
      mesh.corners.insert(mesh.corners.end(), {a, b, d, a, d, c});
    }
  mesh.last_use.assign(mesh.values.size(), 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) mesh.last_use[mesh.corners[i].value()] = i;
  return mesh;
}

TEST(BeadChains, BumpsAlongABorderTakeLittleMemory) {
  constexpr std::size_t kWidth = 60, kLength = 400;
  const Mesh mesh = slope_with_bumps(kWidth, kLength, kLength);
  KeepingSink whole, cut;
  const auto no_options = [](double, double) { return SweepOptions{}; };
  stream(mesh, mesh.corners.size(), whole, no_options);
  EXPECT_GE(whole.graph().arc_count(), 2 * (kWidth / 2 - 2) * (kLength / 2));
  std::size_t most_arcs = 0, most_references = 0, most_bytes = 0;
  stream(mesh, 500, cut, no_options, [&](const Glue& glue) {
    most_arcs = std::max(most_arcs, glue.graph().arc_count());
    most_references = std::max(most_references, glue.graph().reference_count());
    most_bytes = std::max(most_bytes, glue.memory_bytes());
  });
  EXPECT_EQ(cut.graph(), whole.graph());
  const std::size_t bumps = (kWidth / 2 - 2) * (kLength / 2);
  EXPECT_GE(most_arcs, bumps) << "they stay, for later rows could have an arc between two of them";
  EXPECT_LE(most_references, 10 * kWidth) << "few nodes can still change";
  EXPECT_LE(most_bytes, 60 * bumps + 6000 * kWidth);
}

// Edges that a triangle from this one on has in common with an earlier chunk: each is one zip.
std::size_t zips_from(const Mesh& mesh, std::size_t first_triangle, std::size_t chunk_size) {
  std::map<std::pair<VertexId, VertexId>, std::size_t> chunk_of;
  std::size_t zips = 0;
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const std::size_t triangle = i / 3;
    const auto edge = std::minmax(mesh.corners[i], mesh.corners[3 * triangle + (i + 1) % 3]);
    const std::size_t chunk = chunk_of.try_emplace(edge, triangle / chunk_size).first->second;
    if (triangle >= first_triangle && chunk != triangle / chunk_size) ++zips;
  }
  return zips;
}

// Smooth rows after many with bumps. Where an arc without beads takes those of another one, the zip hands the chain
// over; only a chain that is cut, or meets another one, is gone over bead by bead.
TEST(BeadChains, AreHandedOverWhole) {
  constexpr std::size_t kWidth = 8, kLength = 1500, kBumpy = 1000, kChunk = 30;
  const Mesh mesh = slope_with_bumps(kWidth, kLength, kBumpy);
  for (const bool embeds : {false, true}) {
    SCOPED_TRACE(embeds ? "with buckets" : "without buckets");
    SweepOptions options;
    if (embeds) options.bucket_exponent = -1;
    const auto same_options = [&](double, double) { return options; };
    KeepingSink whole, cut;
    stream(mesh, mesh.corners.size(), whole, same_options);
    std::size_t triangles = 0, bumpy_triangles = 0, most_beads = 0;
    std::uint64_t bumpy_steps = 0, steps = 0;
    stream(mesh, kChunk, cut, same_options, [&](const Glue& glue) {
      triangles += kChunk;
      const bool in_bumpy = triangles < 2 * kWidth * (kBumpy + 4);
      most_beads = std::max(most_beads, glue.graph().bead_count());
      if (in_bumpy) bumpy_triangles = triangles;
      (in_bumpy ? bumpy_steps : steps) = glue.graph().bead_steps();
    });
    const std::uint64_t zips = zips_from(mesh, bumpy_triangles, kChunk);
    EXPECT_EQ(cut.graph(), whole.graph());
    EXPECT_GE(most_beads, kBumpy / 2) << "what is to be shown needs long chains";
    EXPECT_GE(zips, kLength - kBumpy);
    // If each bead were gone over, it would be an eighth of them in each zip.
    EXPECT_LE(12 * (steps - bumpy_steps), most_beads * zips) << most_beads << " beads";
  }
}

}  // namespace
}  // namespace reeb::test
