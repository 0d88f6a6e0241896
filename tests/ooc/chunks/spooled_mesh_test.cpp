#include "ooc/chunks/spooled_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libreeb/base/error.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

// Delivers a model mesh in batches: all vertices, a range at a time, then triangles, then tetrahedra.
class ModelReader : public MeshReader {
 public:
  explicit ModelReader(const ModelMesh& mesh, std::vector<VertexId> tetrahedra = {})
      : mesh_(mesh), tetrahedra_(std::move(tetrahedra)) {}
  const MeshInfo& info() const override { return info_; }
  bool read(MeshBatch& batch) override {
    batch.clear();
    batch.coordinates.resize(3);
    batch.properties.resize(mesh_.columns.size() - 3);
    const std::size_t vertices = std::min<std::size_t>(1000, mesh_.vertex_count() - vertex_);
    for (std::size_t k = 0; k < mesh_.columns.size(); ++k) {
      const auto from = mesh_.columns[k].begin() + static_cast<std::ptrdiff_t>(vertex_);
      batch.column(k).assign(from, from + static_cast<std::ptrdiff_t>(vertices));
    }
    batch.first_vertex = VertexId(vertex_);
    batch.vertex_count = vertices;
    vertex_ += vertices;
    if (vertices == 0) {
      const std::size_t corners = std::min<std::size_t>(999, mesh_.corners.size() - corner_);
      const auto from = mesh_.corners.begin() + static_cast<std::ptrdiff_t>(corner_);
      batch.triangles().assign(from, from + static_cast<std::ptrdiff_t>(corners));
      corner_ += corners;
      if (corners == 0) batch.tetrahedra() = std::exchange(tetrahedra_, {});
    }
    return !batch.empty();
  }
  std::uint64_t bytes_read() const override { return corner_; }
  std::uint64_t memory_bytes() const override { return kept_bytes; }

  std::uint64_t kept_bytes = 0;

 private:
  const ModelMesh& mesh_;
  std::vector<VertexId> tetrahedra_;
  MeshInfo info_;
  std::size_t vertex_ = 0, corner_ = 0;
};

void expect_places(const ModelMesh& model, SpooledMesh& mesh, std::mt19937_64& random) {
  std::vector<std::pair<MeshPlace, std::size_t>> places;  // and the corners before
  std::vector<VertexId> some;
  mesh.rewind();
  std::size_t at = 0;
  do {
    places.emplace_back(*mesh.place(), at);
    if (!mesh.read(some, 1 + random() % 3000)) break;
    at += some.size();
  } while (true);
  for (int trial = 0; trial < 200; ++trial) {
    const auto& [place, before] = places[random() % places.size()];
    mesh.seek(place);
    if (!mesh.read(some, 500)) some.clear();
    ASSERT_EQ(some.size(), std::min<std::size_t>(1500, model.corners.size() - before));
    ASSERT_TRUE(std::equal(some.begin(), some.end(), model.corners.begin() + static_cast<std::ptrdiff_t>(before)));
  }
}

void compare(const ModelMesh& model, std::uint64_t allowance, bool must_spill) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(64 << 20);
  {
    ModelReader reader(model);
    const auto mesh = spool(reader, temp, budget, {.allowance_bytes = allowance});
    EXPECT_EQ(mesh->spilled_bytes() > 0, must_spill);
    EXPECT_EQ(mesh->vertex_count(), model.vertex_count());
    EXPECT_EQ(mesh->triangle_count(), model.corners.size() / 3);
    ASSERT_EQ(mesh->column_count(), model.columns.size());
    for (const std::size_t limit : {1u, 7u, 5000u}) {
      EXPECT_EQ(all_corners(*mesh, limit), model.corners);
      EXPECT_EQ(mesh->bytes_read(), mesh->bytes_total());
    }
    std::mt19937_64 random(1);
    expect_places(model, *mesh, random);
    std::vector<VertexId> ids;
    for (int i = 0; i < 2000; ++i) ids.emplace_back(random() % model.vertex_count());
    const std::vector<unsigned> columns = {2, 0, 3};
    std::vector<double> values(columns.size() * ids.size());
    mesh->gather(ids, columns, values);
    for (std::size_t k = 0; k < columns.size(); ++k)
      for (std::size_t i = 0; i < ids.size(); ++i)
        ASSERT_EQ(values[k * ids.size() + i], model.columns[columns[k]][ids[i].value()]);
  }
  EXPECT_EQ(budget.used_bytes(), 0u);
  EXPECT_TRUE(scratch.empty());
}

ModelMesh with_property(ModelMesh mesh) {
  mesh.columns.emplace_back();
  for (std::uint64_t v = 0; v < mesh.vertex_count(); ++v)  // float64 from the middle to the end
    mesh.columns[3].push_back(v < mesh.vertex_count() / 2 ? 0.5 : 0.1 * static_cast<double>(v));
  return mesh;
}

TEST(SpooledMesh, GivesBackWhatWasRead) {
  const ModelMesh rows = with_property(grid_mesh(300, 250));
  compare(rows, 32 << 20, false);
  compare(shuffled(rows, 3), 32 << 20, false);
}

TEST(SpooledMesh, GivesBackWhatWasReadWhenItSpills) {
  ModelMesh rows = with_property(grid_mesh(400, 400));
  compare(rows, 0, true);
  compare(shuffled(rows, 4), 1 << 20, true);
}

TEST(SpooledMesh, ChargesWhatTheReaderKeeps) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget(8 << 20);
  const ModelMesh model = with_property(grid_mesh(20, 20));
  ModelReader modest(model), greedy(model);
  modest.kept_bytes = 1 << 20;
  greedy.kept_bytes = 9 << 20;
  const auto mesh = spool(modest, temp, budget, {.allowance_bytes = 1 << 20});
  EXPECT_GE(budget.peak_bytes(), modest.kept_bytes);
  EXPECT_LT(budget.used_bytes(), modest.kept_bytes + (1 << 20)) << "given back at the end";
  EXPECT_THROW(spool(greedy, temp, budget, {.allowance_bytes = 1 << 20}), Error);
}

TEST(SpooledMesh, AnEmptyMesh) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const ModelMesh model{std::vector<std::vector<double>>(3), {}};
  ModelReader reader(model);
  const auto mesh = spool(reader, temp, budget);
  EXPECT_EQ(mesh->vertex_count(), 0u);
  EXPECT_EQ(mesh->column_count(), 3u);
  EXPECT_TRUE(all_corners(*mesh, 10).empty());
}

TEST(SpooledMesh, ATetrahedronIsTheFacesThatDecideOrAllFour) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const ModelMesh model{std::vector<std::vector<double>>(3, {0, 1, 2, 3}), {}};
  const auto faces = [&](CellTriangles cells) {
    ModelReader reader(model, {VertexId(3), VertexId(1), VertexId(0), VertexId(2)});
    const auto mesh = spool(reader, temp, budget, {.cells = cells});
    EXPECT_EQ(mesh->simplex_counts(), (SimplexCounts{0, 0, 0, 1}));
    std::vector<std::uint64_t> sets;  // of bits
    const auto corners = all_corners(*mesh, 10);
    for (std::size_t t = 0; t < corners.size(); t += 3)
      sets.push_back(1u << corners[t].value() | 1u << corners[t + 1].value() | 1u << corners[t + 2].value());
    std::sort(sets.begin(), sets.end());
    return sets;
  };
  EXPECT_EQ(faces(CellTriangles::kDeciding), (std::vector<std::uint64_t>{0b0111, 0b1011, 0b1101}));
  EXPECT_EQ(faces(CellTriangles::kAll), (std::vector<std::uint64_t>{0b0111, 0b1011, 0b1101, 0b1110}));
}

TEST(SpooledMesh, SignedZerosAndOddValues) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const ModelMesh model{{{-0.0, 1e300, 5e-324}, {1, 2, 3}, {0, 0, 1}}, {}};
  ModelReader reader(model);
  const auto mesh = spool(reader, temp, budget);
  const std::vector<VertexId> ids = {VertexId(0), VertexId(1), VertexId(2)};
  std::vector<double> values(3);
  mesh->gather(ids, std::vector<unsigned>{0}, values);
  EXPECT_FALSE(std::signbit(values[0]));
  EXPECT_EQ(values[1], 1e300);
  EXPECT_EQ(values[2], 5e-324);
  const ModelMesh odd{{{0, 1, 2}, {1, 2, 3}, {0, nan, 1}}, {}};
  ModelReader odd_reader(odd);
  try {
    spool(odd_reader, temp, budget);
    FAIL() << "a coordinate that is not a number passed";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(e.position(), "vertex 1");
  }
}

TEST(SpooledMesh, IdsBeyond32Bits) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  MemoryBudget budget;
  TriangleLog log(temp, budget, 0);
  std::mt19937_64 random(5);
  std::vector<VertexId> corners, back, some;
  for (int c = 0; c < 30'000; ++c) corners.emplace_back(random() >> (random() % 64));
  log.append(corners);
  while (log.read(some, 11)) back.insert(back.end(), some.begin(), some.end());
  EXPECT_EQ(back, corners);
  EXPECT_GT(log.spilled_bytes(), 0u);
}

TEST(SpooledMesh, EachFailingWriteIsReported) {
  const ModelMesh model = with_property(grid_mesh(400, 400));
  expect_failing_writes_are_reported([&](const io::TempDir& temp, MemoryBudget& budget) {
    ModelReader reader(model);
    spool(reader, temp, budget, {.allowance_bytes = 0});
  });
}

}  // namespace
}  // namespace reeb::ooc
