// When a stream is given up: if it has no order, or does not finalize its vertices, and never if it is coherent.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "libreeb/base/memory_budget.h"
#include "ooc/chunks/chunk_source.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/random.h"

namespace reeb::test {
namespace {

enum class Comes { kVerticesFirst, kWhenNeeded };
enum class Finalizes { kAtOnce, kNever };
enum class Order { kRows, kRandom };

struct Shape {
  std::uint64_t width = 0, height = 0, layers = 0;  // cubes; no layers: squares
};

// A grid of tetrahedra or triangles as a stream with exact or no finalization.
class GridStream : public MeshReader {
 public:
  GridStream(const Shape& shape, Comes comes, Finalizes finalizes, Order order) : comes_(comes) {
    info_.finalizes = true;
    add_simplices(shape);
    if (order == Order::kRandom) shuffle();
    if (comes == Comes::kWhenNeeded) number_by_first_use();
    last_use_.assign(vertices_, simplices_.size());
    if (finalizes == Finalizes::kNever) return;
    for (std::size_t s = 0; s < simplices_.size(); ++s)
      for (const std::uint64_t v : simplices_[s]) last_use_[v] = s;
  }

  const MeshInfo& info() const override { return info_; }
  MeshInfo& own_info() { return info_; }
  std::uint64_t bytes_read() const override { return 0; }
  std::size_t simplex_count() const { return simplices_.size(); }
  std::size_t simplices_read() const { return next_; }

  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.coordinates.resize(3);
    batch.first_vertex = VertexId(next_vertex_);
    const std::size_t end = std::min<std::size_t>(next_ + 100, simplices_.size());
    std::uint64_t vertices = comes_ == Comes::kVerticesFirst ? vertices_ : next_vertex_;
    for (std::size_t s = next_; s < end; ++s)
      for (const std::uint64_t v : simplices_[s]) vertices = std::max(vertices, v + 1);
    batch.vertex_count = static_cast<std::size_t>(vertices - next_vertex_);
    for (auto& column : batch.coordinates) column.assign(batch.vertex_count, 0.5);
    next_vertex_ = vertices;
    for (; next_ < end; ++next_) {
      auto& corners = batch.simplices[simplices_[next_].size() - 1];
      for (const std::uint64_t v : simplices_[next_]) corners.emplace_back(v);
      for (const std::uint64_t v : simplices_[next_])
        if (last_use_[v] == next_) batch.finalized.emplace_back(v);
    }
    return !batch.empty();
  }

 private:
  void add_simplices(const Shape& shape) {
    const auto vertex = [&](std::uint64_t i, std::uint64_t j, std::uint64_t k) {
      return i + (shape.width + 1) * (j + (shape.height + 1) * k);
    };
    vertices_ = vertex(shape.width, shape.height, shape.layers) + 1;
    for (std::uint64_t k = 0; k < std::max<std::uint64_t>(shape.layers, 1); ++k)
      for (std::uint64_t j = 0; j < shape.height; ++j)
        for (std::uint64_t i = 0; i < shape.width; ++i) {
          std::vector<unsigned> axes(shape.layers == 0 ? 2 : 3);
          std::iota(axes.begin(), axes.end(), 0u);
          do {
            std::uint64_t at[3] = {i, j, k};
            std::vector<std::uint64_t> simplex{vertex(i, j, k)};
            for (const unsigned axis : axes) {
              ++at[axis];
              simplex.push_back(vertex(at[0], at[1], at[2]));
            }
            simplices_.push_back(simplex);
          } while (std::next_permutation(axes.begin(), axes.end()));
        }
  }

  void shuffle() {
    Random random(1);
    for (std::size_t s = simplices_.size(); s > 1; --s) std::swap(simplices_[s - 1], simplices_[random.below(s)]);
  }

  void number_by_first_use() {
    std::vector<std::uint64_t> number(vertices_, vertices_);
    std::uint64_t next = 0;
    for (auto& simplex : simplices_)
      for (std::uint64_t& v : simplex) {
        if (number[v] == vertices_) number[v] = next++;
        v = number[v];
      }
  }

  Comes comes_;
  MeshInfo info_;
  std::vector<std::vector<std::uint64_t>> simplices_;
  std::uint64_t vertices_ = 0, next_vertex_ = 0;
  std::vector<std::size_t> last_use_;
  std::size_t next_ = 0;
};

struct End {
  bool given_up = false;
  double share_read = 0;
};

End run(GridStream& stream) {
  ColumnFunction function(2);
  const std::vector<VertexFunction*> functions = {&function};
  ooc::FunctionValues values(functions, 3);
  MemoryBudget budget(MemoryBudget::kUnlimited);
  const auto source = ooc::chunks_of(stream, values, budget, {.first = 1000, .most = 1000}, {}, 1'000'000'000);
  for (ooc::WorkItem item; source->next(item);) continue;
  return {source->given_up(),
          static_cast<double>(stream.simplices_read()) / static_cast<double>(stream.simplex_count())};
}

constexpr Shape kVolume{30, 30, 40}, kSurface{200, 200, 0}, kWideSurface{8000, 4, 0};

TEST(StreamChunks, CoherentStreamsAreReadToTheirEnd) {
  for (const Shape& shape : {kVolume, kSurface, kWideSurface})
    for (const Comes comes : {Comes::kVerticesFirst, Comes::kWhenNeeded})
      for (const bool announced : {false, true}) {
        GridStream stream(shape, comes, Finalizes::kAtOnce, Order::kRows);
        if (announced) stream.own_info().vertex_count = (shape.width + 1) * (shape.height + 1) * (shape.layers + 1);
        const End end = run(stream);
        EXPECT_FALSE(end.given_up) << shape.width << " x " << shape.height << " x " << shape.layers << ", "
                                   << announced;
        EXPECT_EQ(end.share_read, 1);
      }
}

TEST(StreamChunks, StreamsThatHardlyFinalizeAreGivenUpSoon) {
  for (const Shape& shape : {kVolume, kSurface, kWideSurface})
    for (const Comes comes : {Comes::kVerticesFirst, Comes::kWhenNeeded}) {
      GridStream never(shape, comes, Finalizes::kNever, Order::kRows);
      const End end = run(never);
      EXPECT_TRUE(end.given_up);
      EXPECT_LT(end.share_read, 0.2) << shape.width << " x " << shape.height << " x " << shape.layers;
      GridStream random(shape, comes, Finalizes::kAtOnce, Order::kRandom);
      EXPECT_TRUE(run(random).given_up);
    }
}

TEST(StreamChunks, AShortStreamIsNotWorthGivingUp) {
  GridStream stream({60, 60, 0}, Comes::kWhenNeeded, Finalizes::kNever, Order::kRandom);
  EXPECT_FALSE(run(stream).given_up);
}

}  // namespace
}  // namespace reeb::test
