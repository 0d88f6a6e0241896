// What docs/SEMANTICS.md (Noise removal, Determinism, Conservation) guarantees for any run, on real meshes held in
// memory: the same bytes for chunks of any size, any number of threads and both forms of input; the same noise removed
// as from the exact graph; an embedding that loses no vertex, stays within its buckets, and does not depend on threads.
// The largest meshes and most shapes of runs are left out unless REEB_TEST_ALL is set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>

#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "tests/model/naive_denoise.h"
#include "tests/model/reference_reeb.h"
#include "tests/support/data.h"
#include "tests/support/inputs/embedding_places.h"
#include "tests/support/whole_run.h"

namespace reeb::test {
namespace {

bool runs_all() { return std::getenv("REEB_TEST_ALL") != nullptr; }

std::vector<std::string> mesh_names() {
  constexpr std::uintmax_t kLarge = 1'100'000;  // bytes of a file
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(mesh_folder(), none)) {
    const std::string name = entry.path().filename().string();
    // Tables and a page about them.
    if (name.ends_with(".tsv") || name.ends_with(".md")) continue;
    if (runs_all() || entry.file_size() < kLarge) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct RealInput {
  Complex complex;
  double size = 1;  // of coordinates
};

RealInput read_mesh(const std::string& path, const std::string& function_text) {
  const auto reader = io::open_mesh(path);
  io::FunctionSource function(io::parse_function(function_text), reader->info());
  RealInput input;
  Complex& complex = input.complex;
  for (MeshBatch batch; reader->read(batch);) {
    std::vector<VertexId> ids;
    for (std::size_t i = 0; i < batch.vertex_count; ++i) {
      ids.emplace_back(complex.vertex_count());
      auto& position = complex.positions.emplace_back();
      for (std::size_t k = 0; k < std::min<std::size_t>(3, batch.coordinates.size()); ++k) {
        position[k] = batch.coordinates[k][i];
        input.size = std::max(input.size, std::abs(position[k]));
      }
    }
    std::vector<std::span<const double>> columns;
    for (const unsigned column : function.columns()) columns.emplace_back(batch.coordinates[column]);
    complex.values.resize(complex.vertex_count());
    function.evaluate(ids, columns, std::span(complex.values).last(ids.size()));
    batch.for_each_simplex([&complex](std::span<const VertexId> corners) {
      auto& simplex = complex.simplices.emplace_back();
      for (const VertexId v : corners) simplex.push_back(v.value());
    });
  }
  return input;
}

class RealRun : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  void SetUp() override {
    const auto& [name, function] = GetParam();
    input_ = read_mesh(mesh_folder() + "/" + name, function);
    mesh_.emplace(input_.complex);
    ASSERT_GT(mesh_->vertex_count(), 0u);
  }
  const ComplexMesh& mesh() const { return *mesh_; }
  double coordinate_size() const { return input_.size; }
  bool is_height() const { return std::get<1>(GetParam()) == "z"; }
  double range() const {
    const auto [min, max] = std::minmax_element(input_.complex.values.begin(), input_.complex.values.end());
    return *max - *min;
  }

 private:
  RealInput input_;
  std::optional<ComplexMesh> mesh_;
};

constexpr RunShape kWhole{100'000'000, 1, Form::kIndexed};
constexpr RunShape kFewShapes[] = {
    {1000, 2, Form::kIndexed}, {65536, 4, Form::kStream}, {0, 2, Form::kIndexed}, {500, 2, Form::kIndexed, 20000}};

std::vector<RunShape> shapes_to_run() {
  if (runs_all()) return all_shapes();
  return {std::begin(kFewShapes), std::end(kFewShapes)};
}

TEST_P(RealRun, WritesTheSameBytesHoweverItRuns) {
  for (const bool graph_only : {true, false}) {
    Runner runner(graph_only);
    runner.options().buckets = 0;
    const std::string expected = take_bytes(runner.run(mesh(), kWhole)[0]);
    // A hierarchy depends on the graph alone, so it is made for a few shapes only.
    for (const RunShape& shape : graph_only ? shapes_to_run() : std::vector<RunShape>{kFewShapes[0]})
      EXPECT_TRUE(take_bytes(runner.run(mesh(), shape)[0]) == expected) << shape;
  }
}

TEST_P(RealRun, RemovesNoiseAsFromTheExactGraph) {
  Runner runner(/*graph_only=*/true);
  runner.options().buckets = 0;
  const ReebGraph exact = take_graph(runner.run(mesh(), kWhole)[0]);
  runner.options().buckets = 64;
  runner.options().denoise_is_share = true;
  for (const double share : {0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    runner.options().denoise = share;
    const Denoised expected = denoise_in_rounds(exact, share * range());
    for (const RunShape& shape : kFewShapes) {
      SCOPED_TRACE(testing::Message() << shape << ", share " << share);
      const ReebGraph graph = take_graph(runner.run(mesh(), shape)[0]);
      EXPECT_TRUE(without_positions(graph) == without_positions(expected.graph));
      EXPECT_EQ(runner.results()[0].denoised_pairs, expected.removed_pairs);
    }
  }
}

// For the height function, the centre of a bucket is within the bucket; coordinates are rounded to 2^-44.
void expect_centres_in_their_buckets(const ooc::Level& level, int exponent, double size) {
  const double slack = 0x1p-43 + 1e-12 * size;
  std::size_t outside = 0;
  for (const Bucket& bucket : level.buckets.buckets)
    outside += bucket.mean[2] < std::ldexp(static_cast<double>(bucket.index), exponent) - slack ||
               bucket.mean[2] > std::ldexp(static_cast<double>(bucket.index + 1), exponent) + slack;
  EXPECT_EQ(outside, 0u) << "of " << level.buckets.buckets.size() << " buckets";
}

TEST_P(RealRun, EmbedsWithinABucketWhateverTheChunksAndAlikeForAnyThreads) {
  Runner runner(/*graph_only=*/true);
  const std::string whole = runner.run(mesh(), kWhole)[0];
  const ooc::Level expected = ooc::ReebFile(whole).load();
  const int exponent = ooc::ReebFile(whole).header().bucket_exponent;
  if (is_height()) expect_centres_in_their_buckets(expected, exponent, coordinate_size());
  for (const std::size_t chunk : {1000u, 65536u, 0u})
    for (const Form form : {Form::kIndexed, Form::kStream}) {
      std::string bytes;
      for (const unsigned threads : {1u, 2u, 4u}) {
        const RunShape shape{chunk, threads, form};
        SCOPED_TRACE(testing::Message() << shape);
        const std::string output = runner.run(mesh(), shape)[0];
        if (threads == 1) {
          const ooc::Level level = ooc::ReebFile(output).load();
          ASSERT_NO_FATAL_FAILURE(expect_same_places(level, expected, exponent, coordinate_size()));
          if (is_height()) expect_centres_in_their_buckets(level, exponent, coordinate_size());
          bytes = read_file(output);
        }
        EXPECT_TRUE(take_bytes(output) == bytes);
      }
    }
}

std::string test_name(const testing::TestParamInfo<RealRun::ParamType>& param) {
  std::string name = std::get<0>(param.param) + "_" + std::get<1>(param.param);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealRun,
                         testing::Combine(testing::ValuesIn(mesh_names()), testing::Values("z", "random:1")),
                         test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealRun);

// Without this test, a folder without meshes would run no test and report no failure.
TEST(RealRuns, HaveMeshes) {
  REEB_REQUIRE_MESHES();
  EXPECT_GE(mesh_names().size(), 10u) << "in " << mesh_folder();
}

}  // namespace
}  // namespace reeb::test
