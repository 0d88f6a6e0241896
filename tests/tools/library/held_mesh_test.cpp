// Readers of a user's program that break a rule: an error that says which, whatever the function and the way of
// reading.
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "tests/support/scratch.h"
#include "tools/library/compute.h"

namespace reeb {
namespace {

// Two triangles in a square, in two batches: vertices, then triangles.
struct Square {
  MeshInfo info;
  std::vector<MeshBatch> batches;

  Square() {
    info.property_names = {"heat"};
    batches.resize(2);
    batches[0].vertex_count = 4;
    batches[0].coordinates = {{0, 1, 1, 0}, {0, 0, 1, 1}, {0, 1, 2, 3}};
    for (const std::uint64_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) batches[1].triangles().emplace_back(corner);
  }
};

class SquareReader : public MeshReader {
 public:
  SquareReader(Square square, std::size_t properties) : square_(std::move(square)) {
    if (square_.batches[0].properties.empty()) square_.batches[0].properties.assign(properties, {5, 6, 7, 8});
  }
  const MeshInfo& info() const override { return square_.info; }
  bool read(MeshBatch& batch) override {
    batch.clear();
    if (next_ == square_.batches.size()) return false;
    batch = square_.batches[next_++];
    return true;
  }
  std::uint64_t bytes_read() const override { return 0; }

 private:
  Square square_;
  std::size_t next_ = 0;
};

std::string error_of(const Square& square, const std::string& function) {
  const ooc::Scratch scratch;
  const std::string output = scratch.path() + "/out.reeb";
  const MeshOpener open = [&](const ReadOptions& options) {
    return std::make_unique<SquareReader>(square, options.properties.size());
  };
  try {
    compute(open, std::span(&function, 1), std::span(&output, 1));
    return {};
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << error.what();
    EXPECT_FALSE(std::filesystem::exists(output));
    return error.message();
  }
}

TEST(HeldMesh, AReaderThatKeepsTheRulesIsRead) {
  for (const std::string function : {"z", "index", "random:1", "property:heat", "geodesic:0", "laplacian:1"})
    EXPECT_EQ(error_of({}, function), "") << function;
}

TEST(HeldMesh, ARuleThatIsBrokenIsNamed) {
  struct Case {
    std::string text;
    std::function<void(Square&)> change;
  };
  const std::vector<Case> cases = {
      {"names vertex 4, but so far there are 4", [](Square& s) { s.batches[1].triangles()[3] = VertexId(4); }},
      {"names vertex 18446744073709551615", [](Square& s) { s.batches[1].triangles()[3] = VertexId::none(); }},
      {"names vertex 0, but so far there are 0", [](Square& s) { std::swap(s.batches[0], s.batches[1]); }},
      {"lacks corners", [](Square& s) { s.batches[1].triangles().pop_back(); }},
      {"what is final includes vertex 9", [](Square& s) { s.batches[1].finalized.emplace_back(9u); }},
      {"has 2 columns of coordinates, not 3", [](Square& s) { s.batches[0].coordinates.pop_back(); }},
      {"a column of coordinates has 3 numbers for 4 vertices",
       [](Square& s) { s.batches[0].coordinates[1].pop_back(); }},
      {"begins with vertex 1", [](Square& s) { s.batches[0].first_vertex = VertexId(1); }},
      {"begins with vertex 0", [](Square& s) { s.batches.push_back(s.batches[0]); }},
      {"at least one coordinate", [](Square& s) { s.info.dimension = 0, s.batches[0].coordinates.clear(); }},
  };
  for (const auto& [text, change] : cases)
    for (const std::string function : {"index", "geodesic:0", "laplacian:1"}) {
      Square square;
      change(square);
      EXPECT_NE(error_of(square, function).find(text), std::string::npos)
          << function << ": \"" << error_of(square, function) << "\" instead of \"" << text << '"';
    }
}

TEST(HeldMesh, APropertyThatIsNotThereIsRefused) {
  Square without;
  without.info.property_names.clear();
  EXPECT_NE(error_of(without, "property:heat").find("no vertex property \"heat\""), std::string::npos);
  Square ragged;
  ragged.batches[0].properties = {{1, 2, 3}};
  EXPECT_NE(error_of(ragged, "property:heat").find("a column of properties"), std::string::npos);
}

TEST(HeldMesh, ThereMustBeAReader) {
  const std::string function = "z", output = "unused.reeb";
  const MeshOpener none, null = [](const ReadOptions&) { return std::unique_ptr<MeshReader>(); };
  EXPECT_THROW(compute(none, std::span(&function, 1), std::span(&output, 1)), Error);
  EXPECT_THROW(compute(null, std::span(&function, 1), std::span(&output, 1)), Error);
}

}  // namespace
}  // namespace reeb
