// A checkpoint with other bytes and a right checksum: the run ends with a graph or with an Error, whatever the bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "io/file/checksum.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "libreeb/base/error.h"
#include "ooc/checkpoints/partial_folder.h"
#include "ooc/run/compute.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/files.h"
#include "tests/support/scratch.h"
#include "tests/support/seed.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;
using test::read_file;
using test::write_file;

// Binary, it is read in place and last uses are found first; as text, it is read once, with guesses.
std::string ply(const ModelMesh& mesh, bool binary) {
  std::ostringstream out;
  out << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex " << mesh.vertex_count()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.corners.size() / 3
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](const auto& value) {
    if (binary)
      out.write(reinterpret_cast<const char*>(&value), sizeof value);
    else
      out << +value << ' ';
  };
  const char* const line_end = binary ? "" : "\n";
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v, out << line_end)
    for (const auto& column : mesh.columns) put(column[v]);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i, out << (i % 3 == 0 ? line_end : "")) {
    if (i % 3 == 0) put(std::uint8_t{3});
    put(static_cast<std::int32_t>(mesh.corners[i].value()));
  }
  return out.str();
}

class Forgery {
 public:
  explicit Forgery(bool binary) {
    write_file(mesh_, ply(grid_mesh(24, 20), binary));
    EXPECT_THROW(run(false, 5), Error);
    fs::rename(partial_, kept_);
    good_ = read_file(kept_ + "/checkpoint");
  }
  const std::string& good() const { return good_; }

  // Resumes from a checkpoint of these bytes, apart from the checksum at their end.
  void resume(std::string bytes) {
    const std::uint64_t checksum = io::checksum(std::as_bytes(std::span(bytes).first(bytes.size() - 8)));
    std::memcpy(bytes.data() + bytes.size() - 8, &checksum, 8);
    fs::remove_all(partial_);
    fs::copy(kept_, partial_);
    write_file(partial_ + "/checkpoint", bytes);
    fs::remove(output_);
    try {
      run(true, ~std::uint64_t{0});
    } catch (const Error& error) {
      ++errors_;
      last_error_ = error.what();
      EXPECT_NE(last_error_, "");
    }
  }
  int errors() const { return errors_; }
  const std::string& last_error() const { return last_error_; }
  // Of the last run that ended with a graph.
  const std::vector<std::string>& notes() const { return notes_; }
  std::string graph() const { return read_file(output_); }

 private:
  void run(bool resume, std::uint64_t chunks) {
    MeshInput input;
    input.path = mesh_;
    input.reader = io::open_mesh(mesh_);
    io::FunctionSource function(io::parse_function("random:1"), input.reader->info(), {}, mesh_);
    input.indexed = input.reader->indexed();
    if (input.indexed) input.reader.reset();
    VertexFunction* functions[] = {&function};
    std::atomic<std::uint64_t> done = 0;  // other threads ask whether to end
    ComputeOptions options;
    options.chunk_triangles = 64;
    options.denoise = 0.05;
    options.resume = resume;
    options.checkpoint_seconds = 1e9;
    options.progress = [&](const ComputeProgress& p) { done += p.phase == ComputeProgress::Phase::kReeb ? 1 : 0; };
    options.interrupted = [&] { return done >= chunks; };
    notes_ = compute(std::move(input), functions, std::span(&output_, 1), options).at(0).notes;
  }

  const Scratch scratch_;
  const std::string mesh_ = scratch_.path() + "/mesh.ply", output_ = scratch_.path() + "/OUT.reeb";
  const std::string partial_ = PartialFolder::path_for(output_), kept_ = scratch_.path() + "/kept";
  std::string good_, last_error_;
  std::vector<std::string> notes_;
  int errors_ = 0;
};

class ForgedCheckpoint : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Forms, ForgedCheckpoint, testing::Bool(),
                         [](const auto& form) { return form.param ? "Binary" : "Text"; });

TEST_P(ForgedCheckpoint, NeverCrashesOrHangs) {
  Forgery forgery(GetParam());
  forgery.resume(forgery.good());
  ASSERT_EQ(forgery.errors(), 0);
  std::mt19937_64 random(test::base_seed());
  const std::uint64_t words[] = {0,         1, 2, 7, 255, 4096, 0x7fffffff, 0xfffffffe, 0xffffffff, ~std::uint64_t{0},
                                 1ull << 62};
  for (std::uint64_t n = 0; n < test::case_count(1000); ++n) {
    std::string bad = forgery.good();
    for (std::uint64_t change = 0; change <= n % 3; ++change) {
      // Half of the changes are in the header and the small numbers after it.
      const std::size_t end = random() % 2 == 0 ? std::min<std::size_t>(bad.size(), 400) : bad.size();
      const std::size_t at = random() % (end - 8) & ~std::size_t{3};
      const std::size_t bytes = random() % 3 == 0 ? 8 : 4;
      const std::uint64_t word = random() % 2 == 0 ? words[random() % std::size(words)] : random() % 500;
      if (random() % 3 == 0)
        bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
      else
        std::memcpy(bad.data() + at, &word, bytes);
    }
    SCOPED_TRACE(testing::Message() << "change " << n);
    forgery.resume(bad);
  }
  EXPECT_GT(forgery.errors(), 0);
}

TEST_P(ForgedCheckpoint, OfAnotherVersionIsIgnoredAndTheRunSaysSo) {
  Forgery forgery(GetParam());
  forgery.resume(forgery.good());
  const std::string graph = forgery.graph();
  EXPECT_TRUE(
      std::ranges::none_of(forgery.notes(), [](const auto& note) { return note.find("checkpoint") != note.npos; }));
  constexpr std::size_t kVersion = 8;
  for (const int change : {-1, 1}) {
    std::string other = forgery.good();
    other[kVersion] = static_cast<char>(other[kVersion] + change);
    forgery.resume(other);
    EXPECT_EQ(forgery.errors(), 0) << forgery.last_error();
    EXPECT_NE(std::ranges::find(forgery.notes(),
                                "the checkpoint is of another version, so the run starts from the beginning"),
              forgery.notes().end());
    EXPECT_EQ(forgery.graph(), graph);
  }
}

// What is read again up to the place of the checkpoint has another digest.
TEST_P(ForgedCheckpoint, OfOtherTrianglesIsThatOfAChangedMesh) {
  constexpr std::size_t kDigest = 15 * 8;
  Forgery forgery(GetParam());
  std::string bad = forgery.good();
  bad[kDigest] = static_cast<char>(bad[kDigest] ^ 1);
  forgery.resume(bad);
  EXPECT_NE(forgery.last_error().find("the mesh has changed since the interrupted run"), std::string::npos)
      << forgery.last_error();
}

}  // namespace
}  // namespace reeb::ooc
