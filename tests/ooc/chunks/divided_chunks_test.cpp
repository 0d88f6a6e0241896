#include "ooc/chunks/divided_chunks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

using test::Random;

// Delivers chunks that were made in advance.
class Made : public ChunkSource {
 public:
  explicit Made(std::vector<WorkItem> items) : items_(std::move(items)) {}
  bool next(WorkItem& item) override {
    if (next_ == items_.size()) return false;
    item = items_[next_++];
    return true;
  }
  std::uint64_t bytes_read() const override { return 0; }
  std::uint64_t bytes_total() const override { return 0; }
  std::uint64_t triangles_read() const override { return 0; }
  SimplexCounts simplices_listed() const override { return {}; }
  std::uint64_t vertex_count() const override { return 0; }

 private:
  std::vector<WorkItem> items_;
  std::size_t next_ = 0;
};

// A strip of a grid in rows, two triangles per cell.
WorkItem strip(std::uint32_t columns, std::uint32_t rows) {
  WorkItem item;
  item.values.resize(1);
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x) {
      item.chunk.ids.emplace_back(item.chunk.ids.size());
      item.chunk.uses.push_back(kUsedHereOnly);
      item.chunk.positions.push_back({double(x), double(y), 0});
      item.values[0].push_back(double(x * y));
    }
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return y * (columns + 1) + x; };
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x)
      for (const std::uint32_t corner :
           {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y), at(x + 1, y + 1), at(x, y + 1)})
        item.chunk.corners.push_back(corner);
  return item;
}

enum class Places { kRandom, kOne, kFew, kNone };

WorkItem random_item(Random& random, Places places) {
  WorkItem item;
  item.values.resize(random.between(1, 2));
  const std::uint64_t vertices = random.between(1, 60), first = random.below(1000);
  for (std::uint64_t i = 0; i < vertices; ++i) {
    item.chunk.ids.emplace_back(first + 7 * i);
    item.chunk.uses.push_back(static_cast<std::uint8_t>(random.below(4)));
    const double x = places == Places::kOne ? 1 : places == Places::kFew ? double(random.below(3)) : random.unit();
    if (places != Places::kNone) item.chunk.positions.push_back({x, x * random.unit(), 0});
    for (auto& values : item.values) values.push_back(random.unit());
  }
  for (std::uint64_t n = 3 * random.below(200); n > 0; --n)
    item.chunk.corners.push_back(static_cast<std::uint32_t>(random.below(vertices)));
  item.end.triangles = random.next();
  return item;
}

// The content of a stretch is in its chunks exactly once, and the uses of each vertex are correct.
void expect_whole(const WorkItem& stretch, const std::vector<WorkItem>& chunks) {
  struct Seen {
    std::size_t first, last;
  };
  std::map<VertexId, Seen> seen;
  std::map<VertexId, std::size_t> in_stretch;
  for (std::size_t v = 0; v < stretch.chunk.ids.size(); ++v) in_stretch[stretch.chunk.ids[v]] = v;
  std::vector<std::array<VertexId, 3>> triangles, expected;
  const auto add = [](const Chunk& chunk, auto& to) {
    for (std::size_t i = 0; i < chunk.corners.size(); i += 3)
      to.push_back({chunk.ids[chunk.corners[i]], chunk.ids[chunk.corners[i + 1]], chunk.ids[chunk.corners[i + 2]]});
  };
  add(stretch.chunk, expected);
  for (std::size_t c = 0; c < chunks.size(); ++c) {
    add(chunks[c].chunk, triangles);
    for (const VertexId v : chunks[c].chunk.ids) {
      const auto [it, is_new] = seen.try_emplace(v, Seen{c, c});
      ASSERT_TRUE(is_new || it->second.last != c) << "a vertex twice in a chunk";
      it->second.last = c;
    }
    EXPECT_EQ(chunks[c].can_resume_after, c + 1 == chunks.size());
    EXPECT_EQ(chunks[c].end.triangles, stretch.end.triangles);
  }
  std::sort(triangles.begin(), triangles.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(triangles, expected);
  EXPECT_EQ(seen.size(), stretch.chunk.vertex_count());
  for (std::size_t c = 0; c < chunks.size(); ++c)
    for (std::size_t i = 0; i < chunks[c].chunk.vertex_count(); ++i) {
      const VertexId id = chunks[c].chunk.ids[i];
      const std::size_t v = in_stretch.at(id);
      const int uses =
          stretch.chunk.uses[v] | (seen.at(id).first < c ? kUsedEarlier : 0) | (seen.at(id).last > c ? kUsedLater : 0);
      ASSERT_EQ(int{chunks[c].chunk.uses[i]}, uses);
      if (!stretch.chunk.positions.empty()) {
        ASSERT_EQ(chunks[c].chunk.positions[i], stretch.chunk.positions[v]);
      }
      for (std::size_t f = 0; f < stretch.values.size(); ++f) ASSERT_EQ(chunks[c].values[f][i], stretch.values[f][v]);
    }
}

std::vector<WorkItem> all_of(DividedChunks& source) {
  std::vector<WorkItem> chunks;
  for (WorkItem item; source.next(item);) chunks.push_back(item);
  return chunks;
}

TEST(DividedChunks, HaveWhatTheStretchHas) {
  Random random(test::base_seed());
  for (std::uint64_t c = test::case_count(2000); c > 0 && !testing::Test::HasFailure(); --c) {
    std::vector<WorkItem> stretches;
    for (std::uint64_t n = random.between(1, 3); n > 0; --n)
      stretches.push_back(random_item(random, static_cast<Places>(random.below(4))));
    Made made(stretches);
    MemoryBudget budget;
    const std::size_t patch = random.between(1, 50), whole = patch + random.below(2) * random.below(30);
    DividedChunks source(made, {.first = whole, .patch = patch}, budget, 2);
    const std::vector<WorkItem> chunks = all_of(source);
    auto chunk = chunks.begin();
    for (const WorkItem& stretch : stretches) {
      auto end = chunk;
      while (!end->can_resume_after) ++end;
      const std::vector<WorkItem> own(chunk, ++end);
      expect_whole(stretch, own);
      for (const WorkItem& item : own)
        EXPECT_LE(item.chunk.triangle_count(), own.size() == 1 ? whole + whole / 4 : patch);
      chunk = end;
    }
    EXPECT_EQ(chunk, chunks.end());
  }
}

// Patches have numbers of 16 bits. So there are fewer than asked for, and larger ones.
TEST(DividedChunks, HaveWhatTheStretchHasWhereManyPatchesAreAskedFor) {
  const WorkItem stretch = strip(256, 128);
  ASSERT_EQ(stretch.chunk.triangle_count(), 65'536u);
  Made made({stretch});
  MemoryBudget budget;
  DividedChunks source(made, {.first = 1, .patch = 1}, budget, 2);
  const std::vector<WorkItem> chunks = all_of(source);
  EXPECT_GT(chunks.size(), 10'000u);
  expect_whole(stretch, chunks);
}

// The border of a strip's patches is like that of a sixteenth of the strip, not like that of its rows.
TEST(DividedChunks, HaveShortBorders) {
  Made made({strip(4000, 25)});
  MemoryBudget budget;
  DividedChunks source(made, {.first = 200'000 / 16, .patch = 200'000 / 16}, budget, 2);
  std::size_t shared = 0, chunks = 0;
  for (WorkItem item; source.next(item); ++chunks) {
    EXPECT_LE(item.chunk.triangle_count(), 200'000 / 16 * 1.1);
    shared += static_cast<std::size_t>(std::count_if(item.chunk.uses.begin(), item.chunk.uses.end(),
                                                     [](std::uint8_t u) { return u != kUsedHereOnly; }));
  }
  EXPECT_GE(chunks, 16u);
  EXPECT_LE(chunks, 32u);
  EXPECT_LE(shared, chunks * 2 * 40);
  EXPECT_GT(budget.peak_bytes(), 100'000u * 33);
}

}  // namespace
}  // namespace reeb::ooc
