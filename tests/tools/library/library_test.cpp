// reeb::compute(): the mesh of a file to the files of its graphs, as the program does it.
#include "tools/library/compute.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "libreeb/base/error.h"
#include "ooc/reeb_file/reeb_file.h"
#include "tests/support/files.h"
#include "tests/support/scratch.h"
#include "tools/library/fragment.h"
#include "tools/library/run_input.h"

namespace reeb::test {
namespace {

class Folder : public ooc::Scratch {
 public:
  std::string operator/(const char* name) const { return path() + "/" + name; }
};

// A square of four triangles about its highest vertex.
std::string pyramid(const Folder& folder) {
  const std::string path = folder / "pyramid.obj";
  write_file(path,
             "v 0 0 0\nv 1 0 0.1\nv 1 1 0.2\nv 0 1 0.3\nv 0.5 0.5 1\n"
             "f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n");
  return path;
}

ErrorKind kind_of_failure(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_FALSE(error.hint().empty());
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorKind::kInterrupted;
}

TEST(Compute, WritesTheGraphThatItTells) {
  const Folder folder;
  std::string format;
  std::uint64_t triangles = 0;
  const ComputeResult result = compute(
      pyramid(folder), "z", folder / "z.reeb",
      {.opened = [&](const MeshInfo& info) { format = info.format; },
       .progress = [&](const ComputeProgress& progress) { triangles = std::max(triangles, progress.triangles); }});
  EXPECT_EQ(format, "OBJ");
  EXPECT_EQ(triangles, 4u);
  EXPECT_EQ(result.nodes, 2u);
  const ooc::ReebFile file(folder / "z.reeb");
  EXPECT_EQ(file.load().graph.node_count(), 2u);
  EXPECT_EQ(file.header().function, "z");
}

TEST(Compute, SeveralFunctionsAreWhatTheyAreAlone) {
  const Folder folder;
  const std::string mesh = pyramid(folder);
  const std::vector<std::string> functions = {"x", "random:1"}, outputs = {folder / "x.reeb", folder / "r.reeb"};
  const auto results = compute(mesh, functions, outputs);
  ASSERT_EQ(results.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(results[i].function, functions[i]);
    compute(mesh, functions[i], folder / "alone.reeb", {.threads = 1, .replace = true});
    EXPECT_EQ(read_file(folder / "alone.reeb"), read_file(outputs[i]));
  }
}

TEST(Compute, ASmallMeshHasOneThreadUnlessToldOtherwise) {
  const Folder folder;
  const std::string mesh = pyramid(folder);
  EXPECT_EQ(compute(mesh, "z", folder / "one.reeb").threads, 1u);
  EXPECT_EQ(compute(mesh, "z", folder / "two.reeb", {.threads = 2}).threads, 2u);
  EXPECT_EQ(read_file(folder / "one.reeb"), read_file(folder / "two.reeb"));
}

TEST(Compute, TheSizeOfAMeshIsThatOfItsCellsOrElseOfItsBytes) {
  using enum ooc::MeshSize;
  MeshInfo mesh;
  EXPECT_EQ(size_of(mesh), kAny);  // a pipe, of any length
  mesh.file_bytes = 4'000'039;
  EXPECT_EQ(size_of(mesh), kSmall);
  ++mesh.file_bytes;
  EXPECT_EQ(size_of(mesh), kAny);
  for (const auto& [cells, size] :
       {std::pair(0u, kTiny), {10'000u, kTiny}, {10'001u, kSmall}, {100'000u, kSmall}, {100'001u, kAny}}) {
    mesh.simplex_count = cells;
    EXPECT_EQ(size_of(mesh), size) << cells;
  }
  mesh.grid.emplace().size = {9, 9, 9};
  EXPECT_EQ(size_of(mesh), kTiny);
  mesh.grid->size = {20, 20, 20};
  EXPECT_EQ(size_of(mesh), kSmall);
  mesh.grid->size[0] = 21;
  EXPECT_EQ(size_of(mesh), kAny);
}

TEST(Compute, AnOutputIsReplacedOnlyIfThatIsAllowed) {
  const Folder folder;
  const std::string mesh = pyramid(folder), output = folder / "z.reeb";
  compute(mesh, "z", output);
  const auto before = read_file(output);
  EXPECT_EQ(kind_of_failure([&] { compute(mesh, "x", output); }), ErrorKind::kBadInput);
  EXPECT_EQ(read_file(output), before);
  compute(mesh, "x", output, {.replace = true});
  EXPECT_EQ(ooc::ReebFile(output).header().function, "x");
}

TEST(Compute, RefusesNumbersOutOfTheirLimits) {
  const Folder folder;
  const std::string mesh = pyramid(folder), output = folder / "z.reeb";
  const std::vector<std::string> functions = {"z"}, outputs = {output};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<ComputeOptions> bad = {{.denoise = std::numeric_limits<double>::quiet_NaN()},
                                           {.denoise = kInfinity},
                                           {.denoise = -1, .denoise_is_share = true},
                                           {.buckets = kMostBuckets + 1},
                                           {.buckets = ~0u}};
  for (const ComputeOptions& options : bad) {
    EXPECT_EQ(kind_of_failure([&] { compute(mesh, "z", output, options); }), ErrorKind::kUsage);
    EXPECT_EQ(kind_of_failure(
                  [&] { compute_fragments(mesh, functions, outputs, options, {.part = 0, .parts = 2, .shared = {}}); }),
              ErrorKind::kUsage);
    EXPECT_FALSE(std::filesystem::exists(output));
  }
  compute(mesh, "z", output, {.denoise = 0.5, .buckets = kMostBuckets});
}

// From then on an interruption leaves no folder without a checkpoint.
TEST(Compute, AsksForAnInterruptionBeforeItMakesItsFolder) {
  const Folder folder;
  const std::string mesh = pyramid(folder);
  const std::vector<std::string> functions = {"z"}, outputs = {folder / "z.fragment"};
  const auto asks_before_folder = [](const std::string& output, const auto& run) {
    std::vector<bool> had_folder;
    ComputeOptions options;
    options.interrupted = [&] {
      had_folder.push_back(std::filesystem::exists(output + ".partial"));
      return false;
    };
    run(options);
    return had_folder.size() > 1 && !had_folder.front() && had_folder.back();
  };
  EXPECT_TRUE(asks_before_folder(
      folder / "z.reeb", [&](const ComputeOptions& options) { compute(mesh, "z", folder / "z.reeb", options); }));
  EXPECT_TRUE(asks_before_folder(outputs[0], [&](const ComputeOptions& options) {
    compute_fragments(mesh, functions, outputs, options, {.part = 0, .parts = 2, .shared = {}});
  }));
}

TEST(Compute, RefusesWhatItCannotDo) {
  const Folder folder;
  const std::string mesh = pyramid(folder), output = folder / "z.reeb";
  const std::vector<std::string> two = {"x", "y"}, one = {output}, none;
  EXPECT_EQ(kind_of_failure([&] { compute(mesh, two, one); }), ErrorKind::kUsage);
  EXPECT_EQ(kind_of_failure([&] { compute(mesh, none, none); }), ErrorKind::kUsage);
  const ooc::PartChoice half{.part = 0, .parts = 2, .shared = {}};
  EXPECT_EQ(kind_of_failure([&] { compute_fragments(mesh, two, one, {}, half); }), ErrorKind::kUsage);
  EXPECT_EQ(kind_of_failure([&] { compute_fragments(mesh, none, none, {}, half); }), ErrorKind::kUsage);
  EXPECT_EQ(kind_of_failure([&] { compute(mesh, "height", output); }), ErrorKind::kUsage);
  EXPECT_EQ(kind_of_failure([&] { compute(folder / "missing.ply", "z", output); }), ErrorKind::kBadInput);
  EXPECT_EQ(kind_of_failure([&] { compute(mesh, "z", output, {.interrupted = [] { return true; }}); }),
            ErrorKind::kInterrupted);
  EXPECT_FALSE(std::filesystem::exists(output));
  for (const bool keeps : {true, false}) {
    int asked = 0;
    try {
      compute(mesh, "z", output, {.keeps_checkpoints = keeps, .interrupted = [&] { return ++asked > 2; }});
      ADD_FAILURE() << "it was not interrupted";
    } catch (const Error& error) {
      EXPECT_EQ(error.hint().find("--resume") != std::string::npos, keeps) << error.hint();
    }
    EXPECT_EQ(std::filesystem::exists(output + ".partial"), keeps);
    std::filesystem::remove_all(output + ".partial");
  }
  compute(mesh, "z", output);
  EXPECT_EQ(kind_of_failure([&] { compute(output, "z", folder / "again.reeb"); }), ErrorKind::kBadInput);
}

}  // namespace
}  // namespace reeb::test
