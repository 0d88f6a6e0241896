// A run that is interrupted and resumed writes the same bytes as an uninterrupted run.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/file/fault.h"
#include "io/formats/create_mesh.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "libreeb/base/error.h"
#include "ooc/checkpoints/checkpoint.h"
#include "ooc/checkpoints/partial_folder.h"
#include "ooc/run/compute.h"
#include "tests/ooc/chunks/model_mesh.h"
#include "tests/support/files.h"
#include "tests/support/inputs/random_complex.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

namespace fs = std::filesystem;
using Notes = std::vector<std::string>;
using test::read_file;
using test::write_file;

// A PLY file of double coordinates. Binary, it is read in place; as text, it is spooled.
void write_ply(const std::string& path, const ModelMesh& mesh, bool binary) {
  std::ostringstream out;
  out.precision(17);
  out << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex " << mesh.vertex_count()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.corners.size() / 3
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](const auto& value) {
    if (!binary) {
      out << +value << ' ';
      return;
    }
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    out.write(bytes, sizeof value);
  };
  const char* line_end = binary ? "" : "\n";
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v, out << line_end)
    for (const auto& column : mesh.columns) put(column[v]);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i, out << (i % 3 == 0 ? line_end : "")) {
    if (i % 3 == 0) put(std::uint8_t{3});
    put(static_cast<std::int32_t>(mesh.corners[i].value()));
  }
  write_file(path, out.str());
}

// A streaming mesh: a vertex comes when a triangle needs it, and may be finalized with the last triangle that does.
void write_stream(const std::string& path, const ModelMesh& mesh, bool finalizes = true) {
  std::vector<std::size_t> last_use(mesh.vertex_count(), 0);
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) last_use[mesh.corners[i].value()] = i / 3;
  const auto writer = io::create_mesh(path, {.existing = io::Existing::kReplace});
  std::uint64_t next = 0;
  for (std::size_t t = 0; t <= mesh.corners.size() / 3; ++t) {
    const bool at_end = t == mesh.corners.size() / 3;  // with the unused vertices
    MeshBatch batch;
    batch.first_vertex = VertexId(next);
    if (!at_end)
      batch.triangles().assign(mesh.corners.begin() + 3 * static_cast<std::ptrdiff_t>(t),
                               mesh.corners.begin() + 3 * static_cast<std::ptrdiff_t>(t + 1));
    std::uint64_t end = at_end ? mesh.vertex_count() : next;
    for (const VertexId v : batch.triangles()) {
      end = std::max(end, v.value() + 1);
      if (finalizes && last_use[v.value()] == t &&
          std::find(batch.finalized.begin(), batch.finalized.end(), v) == batch.finalized.end())
        batch.finalized.push_back(v);
    }
    batch.vertex_count = end - next;
    for (const auto& column : mesh.columns)
      batch.coordinates.emplace_back(column.begin() + static_cast<std::ptrdiff_t>(next),
                                     column.begin() + static_cast<std::ptrdiff_t>(end));
    next = end;
    writer->write(batch);
  }
  writer->close();
}

// Values as z; edges and vertices as degenerate triangles.
ModelMesh mesh_of(const test::Complex& complex) {
  ModelMesh mesh{std::vector<std::vector<double>>(3), {}};
  for (std::size_t v = 0; v < complex.vertex_count(); ++v) {
    for (std::size_t k = 0; k < 2; ++k) mesh.columns[k].push_back(complex.positions[v][k]);
    mesh.columns[2].push_back(complex.values[v]);
  }
  const test::Skeleton skeleton = test::two_skeleton(complex);
  for (const auto& [a, b] : skeleton.edges)
    for (const std::uint64_t corner : {a, b, b}) mesh.corners.emplace_back(corner);
  for (const auto& triangle : skeleton.triangles)
    for (const std::uint64_t corner : triangle) mesh.corners.emplace_back(corner);
  return mesh;
}

// Read in place; spooled, with guesses; with finalization of its own; a closed surface, in place with guesses.
enum class Form { kBinary, kText, kStream, kClosed };
constexpr Form kForms[] = {Form::kBinary, Form::kText, Form::kStream, Form::kClosed};
const char* name_of(Form form) {
  constexpr const char* kNames[] = {"InPlace", "Guessed", "Stream", "GuessedInPlace"};
  return kNames[static_cast<std::size_t>(form)];
}

// One mesh file and runs on it; the output is OUT.reeb in the same folder.
class Runs {
 public:
  explicit Runs(const ModelMesh& mesh, Form form = Form::kBinary, std::string function = "z")
      : form_(form), function_(std::move(function)) {
    write(mesh);
  }

  void write(const ModelMesh& mesh) const {
    if (form_ == Form::kStream)
      write_stream(mesh_path(), mesh);
    else
      write_ply(mesh_path(), mesh, form_ != Form::kText);
  }
  std::string mesh_path() const { return scratch_.path() + (form_ == Form::kStream ? "/mesh.sma" : "/mesh.ply"); }
  std::string output() const { return scratch_.path() + "/OUT.reeb"; }
  std::string partial() const { return PartialFolder::path_for(output()); }
  void set_function(const std::string& function) { function_ = function; }

  ComputeOptions options;
  ReadOptions reading;
  bool may_read_again = false;       // a stream
  std::function<void()> watch = {};  // called after each chunk

  // Runs to the end. Returns the bytes of the output, which is then removed.
  std::string finish(bool resume) {
    Notes ignored;
    return finish(resume, ignored);
  }
  std::string finish(bool resume, Notes& notes) {
    run(resume, ~std::uint64_t{0}, &notes);
    EXPECT_FALSE(fs::exists(partial()));
    const std::string bytes = read_file(output());
    fs::remove(output());
    return bytes;
  }

  // Runs to the end of the n-th chunk, counted from 1. False if the run was shorter; then it wrote its output.
  bool stop_after(std::uint64_t n, bool resume) {
    try {
      run(resume, n, nullptr);
      return false;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInterrupted) << error.what();
      EXPECT_NE(error.hint().find("--resume"), std::string::npos) << error.hint();
      EXPECT_TRUE(PartialFolder::has_checkpoint(output()));
      EXPECT_FALSE(fs::exists(output()));
      return true;
    }
  }

 private:
  void run(bool resume, std::uint64_t chunks, Notes* notes) {
    MeshInput input;
    input.path = mesh_path();
    input.reader = io::open_mesh(input.path, reading);
    io::FunctionSource function(io::parse_function(function_), input.reader->info(), {}, input.path);
    input.indexed = input.reader->indexed();
    if (input.indexed) input.reader.reset();
    if (may_read_again) input.read_again = [this] { return io::open_mesh(mesh_path(), reading); };
    VertexFunction* functions[] = {&function};
    const std::string outputs[] = {output()};
    std::atomic<std::uint64_t> done = 0;  // other threads ask whether to end
    ComputeOptions all = options;
    all.resume = resume;
    all.progress = [&](const ComputeProgress& p) {
      if (p.phase != ComputeProgress::Phase::kReeb) return;
      ++done;
      if (watch) watch();
    };
    all.interrupted = [&] { return done >= chunks; };
    const auto results = compute(std::move(input), functions, outputs, all);
    if (notes) *notes = results[0].notes;
  }

  Scratch scratch_;
  Form form_;
  std::string function_;
};

TEST(Resume, GoesOnFromEveryChunkOfRandomComplexes) {
  std::size_t interruptions = 0;
  for (std::uint64_t seed = 0; seed < 45; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Runs runs(mesh_of(test::random_complex(seed)), kForms[seed % 3]);
    runs.reading.batch_events = 1 + seed % 4;  // of a stream no chunk is cut within a batch
    runs.options.chunk_triangles = 1 + seed % 5;
    runs.options.threads = static_cast<unsigned>(1 + seed % 3);
    const std::string expected = runs.finish(false);
    for (std::uint64_t n = 1; runs.stop_after(n, false); n += 1 + n / 4) {
      ++interruptions;
      ASSERT_EQ(runs.finish(true), expected) << "after chunk " << n;
    }
    fs::remove(runs.output());
  }
  EXPECT_GE(interruptions, 20u);
}

TEST(Resume, GoesOnAsOftenAsItIsInterrupted) {
  std::size_t interruptions = 0;
  for (std::uint64_t seed = 100; seed < 115; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Runs runs(mesh_of(test::random_complex(seed)), kForms[seed % 3]);
    runs.reading.batch_events = 3;
    runs.options.chunk_triangles = 7;
    const std::string expected = runs.finish(false);
    for (bool resume = false; runs.stop_after(1, resume); resume = true) ++interruptions;
    EXPECT_EQ(read_file(runs.output()), expected);
  }
  EXPECT_GE(interruptions, 10u);
}

// Enough nodes for segments on disk. The run is resumed in another way than it began.
class ResumeForm : public testing::TestWithParam<Form> {};
INSTANTIATE_TEST_SUITE_P(Forms, ResumeForm, testing::ValuesIn(kForms),
                         [](const auto& form) { return std::string(name_of(form.param)); });
ModelMesh square_mesh(Form form) { return form == Form::kClosed ? torus_mesh(250, 250) : grid_mesh(250, 250); }

TEST_P(ResumeForm, TakesOverSegmentsWhateverTheThreadsChunksAndMemory) {
  Runs runs(square_mesh(GetParam()), GetParam(), "random:1");
  runs.reading.batch_events = 100;
  runs.options.graph_only = true;  // the least budget has no room for the second stage
  runs.options.buckets = 0;        // an embedding shows where chunks were cut
  runs.options.memory_bytes = 16 << 20;
  runs.options.chunk_triangles = 4096;
  const std::string expected = runs.finish(false);
  std::uint64_t with_segments = 0;
  for (std::uint64_t n = 1; n <= 30; n += 4) {
    runs.options.memory_bytes = 16 << 20;
    runs.options.chunk_triangles = 4096;
    runs.options.threads = 1;
    ASSERT_TRUE(runs.stop_after(n, false));
    with_segments += fs::exists(runs.partial() + "/function-0.arcs");
    runs.options.memory_bytes = n % 8 == 1 ? MemoryBudget::kUnlimited : 17 << 20;
    runs.options.chunk_triangles = n % 3 == 0 ? 0 : 10'000;
    runs.options.threads = 2;
    ASSERT_EQ(runs.finish(true), expected) << "after chunk " << n;
  }
  EXPECT_GT(with_segments, 2u) << "nothing spills any more";
}

// Chunks with adaptive sizes are cut in the same places, and segments return the buckets that were stored.
TEST_P(ResumeForm, GivesTheSameEmbeddingWhateverTheThreads) {
  Runs runs(square_mesh(GetParam()), GetParam(), "random:1");
  runs.reading.batch_events = 100;
  runs.options.graph_only = true;
  runs.options.memory_bytes = 24 << 20;
  runs.options.threads = 2;
  for (const double denoise : {0.0, 0.3}) {
    runs.options.denoise = denoise;
    const std::string expected = runs.finish(false);
    std::uint64_t with_segments = 0;
    for (const std::uint64_t n : {1u, 3u, 5u, 7u}) {
      runs.options.threads = static_cast<unsigned>(1 + n % 3);
      ASSERT_TRUE(runs.stop_after(n, false));
      with_segments += fs::exists(runs.partial() + "/function-0.arcs");
      runs.options.threads = static_cast<unsigned>(1 + n % 2);
      Notes notes;
      ASSERT_EQ(runs.finish(true, notes), expected) << "after chunk " << n;
      EXPECT_NE(notes.at(0).find("continues from there"), std::string::npos) << notes[0];
    }
    if (denoise == 0) {
      EXPECT_GT(with_segments, 0u) << "nothing spills any more";
    }
  }
}

// The checkpoint is from before the mesh was run from disk, or from after that.
TEST(Resume, GoesOnBeforeAndAfterAGuessWasRevoked) {
  ModelMesh mesh = grid_mesh(60, 60);
  const std::vector<VertexId> first(mesh.corners.begin(), mesh.corners.begin() + 1000 * 3);
  mesh.corners.insert(mesh.corners.end(), first.begin(), first.end());
  Runs runs(mesh, Form::kText, "random:1");
  runs.options.chunk_triangles = 500;
  const std::string expected = runs.finish(false);
  const std::uint64_t before = (59 * 59 * 2 + 499) / 500;
  for (const std::uint64_t n : {std::uint64_t{1}, before - 1, before, before + 1, 2 * before})
    for (const unsigned threads : {1u, 2u}) {
      runs.options.threads = threads;
      ASSERT_TRUE(runs.stop_after(n, false));
      Notes notes;
      ASSERT_EQ(runs.finish(true, notes), expected) << "after chunk " << n;
      EXPECT_NE(notes.at(0).find("continues from there"), std::string::npos) << notes[0];
    }
}

TEST(Resume, StartsFromTheBeginningWithOtherSettings) {
  Runs runs(grid_mesh(60, 60), Form::kBinary, "random:1");
  runs.options.chunk_triangles = 500;
  runs.options.buckets = 16;
  const std::string expected = runs.finish(false);
  runs.options.buckets = 8;
  ASSERT_TRUE(runs.stop_after(3, false));
  runs.options.buckets = 16;
  Notes notes;
  EXPECT_EQ(runs.finish(true, notes), expected);
  EXPECT_NE(notes.at(0).find("other options"), std::string::npos) << notes[0];
}

// With more memory a new run would not reorder the mesh; a resumed one must.
TEST(Resume, KeepsToTheOrderInWhichTheRunBegan) {
  Runs runs(shuffled(grid_mesh(150, 150), 5));
  runs.options.buckets = 0;
  const std::string expected = runs.finish(false);
  runs.options.chunk_triangles = 2048;
  for (const std::uint64_t n : {1u, 9u, 20u}) {
    runs.options.memory_bytes = 16 << 20;
    ASSERT_TRUE(runs.stop_after(n, false));
    runs.options.memory_bytes = MemoryBudget::kUnlimited;
    Notes notes;
    ASSERT_EQ(runs.finish(true, notes), expected) << "after chunk " << n;
    EXPECT_NE(testing::PrintToString(notes).find("sorted on disk"), std::string::npos);
  }
}

// Where a stream is hopeless does not depend on where the run was interrupted.
TEST(Resume, GivesAStreamUpWhereAnUninterruptedRunDoes) {
  const ModelMesh mesh = grid_mesh(150, 150);
  Runs runs(mesh, Form::kStream, "random:3");
  write_stream(runs.mesh_path(), mesh, false);
  runs.may_read_again = true;
  runs.reading.batch_events = 500;
  runs.options.chunk_triangles = 1000;
  runs.options.threads = 1;
  runs.options.buckets = 16;
  const auto gives_up = [](const Notes& notes) {
    return testing::PrintToString(notes).find("so it was read again") != std::string::npos;
  };
  Notes notes;
  const std::string expected = runs.finish(false, notes);
  ASSERT_TRUE(gives_up(notes)) << testing::PrintToString(notes);
  for (const std::uint64_t n : {1u, 3u}) {
    ASSERT_TRUE(runs.stop_after(n, false));
    ASSERT_EQ(runs.finish(true, notes), expected) << "after chunk " << n;
    EXPECT_TRUE(gives_up(notes)) << testing::PrintToString(notes);
  }
}

// The same for a mesh in tiles: its pieces are visited in another order.
TEST(Resume, KeepsToTheOrderOfPieces) {
  constexpr std::uint64_t kColumns = 301;
  ModelMesh mesh = in_random_tiles(grid_mesh(kColumns, 301), kColumns, 5, 1);
  for (double& z : mesh.columns[2]) z /= 64;  // else the tiles are near each other, compared with the edges
  for (const Form form : {Form::kBinary, Form::kText}) {
    Runs runs(mesh, form);
    runs.options.buckets = 0;
    runs.options.graph_only = true;
    runs.options.chunk_triangles = 4096;
    Notes notes;
    const std::string expected = runs.finish(false, notes);
    EXPECT_NE(testing::PrintToString(notes).find("pieces"), std::string::npos) << testing::PrintToString(notes);
    for (const std::uint64_t n : {1u, 9u, 30u}) {
      runs.options.memory_bytes = MemoryBudget::kUnlimited;
      ASSERT_TRUE(runs.stop_after(n, false));
      runs.options.memory_bytes = n == 9 ? 24 << 20 : MemoryBudget::kUnlimited;
      ASSERT_EQ(runs.finish(true, notes), expected) << "after chunk " << n;
      EXPECT_NE(testing::PrintToString(notes).find("continues from there"), std::string::npos);
      EXPECT_NE(testing::PrintToString(notes).find("pieces"), std::string::npos);
    }
  }
}

TEST(Resume, StartsFromTheBeginningIfItIsDamaged) {
  Runs runs(grid_mesh(250, 250), Form::kBinary, "random:1");
  runs.options.graph_only = true;  // the least budget has no room for the second stage
  runs.options.memory_bytes = 16 << 20;
  runs.options.chunk_triangles = 4096;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(24, false));
  const fs::path kept = runs.partial() + ".kept";
  fs::rename(runs.partial(), kept);
  std::mt19937_64 random(11);
  for (const char* name : {"checkpoint", "function-0.nodes", "function-0.arcs"}) {
    const std::string good = read_file(kept / name);
    ASSERT_FALSE(good.empty()) << name;
    for (int trial = 0; trial < 12; ++trial) {
      std::string bad = good;
      const std::size_t at = trial == 0 ? 0 : trial == 1 ? good.size() - 1 : random() % good.size();
      if (trial % 2 == 0)
        bad.resize(at);
      else
        bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
      SCOPED_TRACE(testing::Message() << name << (trial % 2 == 0 ? " cut" : " changed") << " at " << at);
      fs::copy(kept, runs.partial());
      write_file(runs.partial() + "/" + name, bad);
      // What the run wrote after the last checkpoint does not matter.
      const bool is_after = std::string(name) != "checkpoint" && bad.substr(0, good.size()) == good;
      Notes notes;
      ASSERT_EQ(runs.finish(true, notes), expected);
      EXPECT_EQ(notes.empty() || notes[0].find("starts from the beginning") == std::string::npos, is_after)
          << testing::PrintToString(notes);
    }
  }
  fs::rename(kept, runs.partial());
  EXPECT_EQ(runs.finish(true), expected);
}

TEST(Resume, RefusesEveryCutAndChangedByteOfASmallCheckpoint) {
  Runs runs(grid_mesh(4, 4));
  runs.options.chunk_triangles = 5;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(2, false));
  const std::string checkpoint = runs.partial() + "/checkpoint";
  const std::string good = read_file(checkpoint);
  for (std::size_t at = 0; at < good.size(); at += 1 + at / 8)
    for (const bool cut : {true, false}) {
      std::string bad = good;
      if (cut)
        bad.resize(at);
      else
        bad[at] = static_cast<char>(bad[at] ^ 0x10);
      fs::create_directory(runs.partial());
      write_file(runs.partial() + "/reeb-partial", "");
      write_file(checkpoint, bad);
      Notes notes;
      ASSERT_EQ(runs.finish(true, notes), expected) << "at " << at;
      ASSERT_FALSE(notes.empty()) << "at " << at;
      ASSERT_NE(notes[0].find("starts from the beginning"), std::string::npos) << "at " << at;
    }
}

TEST(Resume, IgnoresACheckpointOfAnotherMeshOrFunction) {
  Runs runs(grid_mesh(20, 20));
  runs.options.chunk_triangles = 100;
  const std::string of_z = runs.finish(false);
  Notes notes;
  ASSERT_TRUE(runs.stop_after(2, false));
  runs.set_function("x");
  const std::string of_x = runs.finish(true, notes);
  EXPECT_NE(of_x, of_z);
  EXPECT_NE(notes.at(0).find("other functions"), std::string::npos) << notes[0];
  EXPECT_EQ(runs.finish(false), of_x);

  // The same function by name, of other values.
  const Scratch values_folder;
  const std::string values = values_folder.path() + "/values.f64";
  const auto write_values = [&](double step) {
    std::vector<double> numbers(400);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = step * static_cast<double>(i * 7 % 400);
    write_file(values, std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)));
  };
  write_values(1);
  runs.set_function("file:" + values);
  ASSERT_TRUE(runs.stop_after(2, false));
  write_values(-2);
  const std::string of_values = runs.finish(true, notes);
  EXPECT_NE(notes.at(0).find("other functions"), std::string::npos) << notes[0];
  EXPECT_EQ(runs.finish(false), of_values);
  runs.set_function("x");

  ASSERT_TRUE(runs.stop_after(2, false));
  runs.write(grid_mesh(25, 16));
  const std::string of_other = runs.finish(true, notes);
  EXPECT_NE(notes.at(0).find("another mesh"), std::string::npos) << notes[0];
  EXPECT_EQ(runs.finish(false), of_other);
}

TEST(Resume, AnInterruptedRunIsDiscardedOnlyByForce) {
  Runs runs(grid_mesh(20, 20));
  runs.options.chunk_triangles = 100;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(2, false));
  const std::string checkpoint = read_file(runs.partial() + "/checkpoint");
  runs.options.replace = false;
  for (const char* function : {"z", "x"}) {
    runs.set_function(function);
    try {
      runs.finish(false);
      ADD_FAILURE() << "discarded, with " << function;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(error.file(), runs.partial());
      EXPECT_NE(error.hint().find("--force"), std::string::npos) << error.hint();
    }
    EXPECT_EQ(read_file(runs.partial() + "/checkpoint"), checkpoint);
  }
  runs.set_function("z");
  Notes notes;
  EXPECT_EQ(runs.finish(true, notes), expected);
  EXPECT_NE(notes.at(0).find("continues from there"), std::string::npos) << notes[0];
  // What no run can use is no run.
  ASSERT_TRUE(runs.stop_after(2, false));
  write_file(runs.partial() + "/checkpoint", "damaged");
  EXPECT_EQ(runs.finish(false), expected);
}

// The samples that identify a mesh do not show the change, and its time of modification is set back.
TEST(Resume, RefusesAMeshThatWasChangedWithItsTimeKept) {
  Runs runs(grid_mesh(400, 300));
  runs.options.chunk_triangles = 1000;
  ASSERT_TRUE(runs.stop_after(4, false));
  const auto time = fs::last_write_time(runs.mesh_path());
  std::string bytes = read_file(runs.mesh_path());
  std::swap_ranges(bytes.end() - 100'000 * 13, bytes.end() - 99'000 * 13, bytes.end() - 50'000 * 13);
  write_file(runs.mesh_path(), bytes);
  fs::last_write_time(runs.mesh_path(), time);
  try {
    runs.finish(true);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_NE(error.message().find("changed since the interrupted run"), std::string::npos) << error.what();
    EXPECT_NE(error.hint().find("--force"), std::string::npos);
  }
  EXPECT_TRUE(PartialFolder::has_checkpoint(runs.output())) << "the mesh can be brought back";
}

// Only the time at which anything about the file changed shows it.
TEST(Resume, KeepsTheCheckpointOfAMeshThatWasChanged) {
  Runs runs(grid_mesh(20, 20));
  runs.options.chunk_triangles = 100;
  ASSERT_TRUE(runs.stop_after(2, false));
  const std::string checkpoint = read_file(runs.partial() + "/checkpoint");
  const auto time = fs::last_write_time(runs.mesh_path());
  write_file(runs.mesh_path(), read_file(runs.mesh_path()));
  fs::last_write_time(runs.mesh_path(), time);
  for (const bool replace : {false, true}) {
    runs.options.replace = replace;
    try {
      runs.finish(true);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(error.file(), runs.mesh_path());
      EXPECT_NE(error.message().find("changed since the interrupted run"), std::string::npos) << error.what();
      EXPECT_EQ(error.hint(), "start again with --force and without --resume");
    }
    EXPECT_EQ(read_file(runs.partial() + "/checkpoint"), checkpoint);
  }
  runs.finish(false);
}

TEST(Resume, OfAnotherRunIsRefusedUnlessThatMayBeDiscarded) {
  Runs runs(grid_mesh(20, 20));
  runs.options.chunk_triangles = 100;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(2, false));
  const std::string checkpoint = read_file(runs.partial() + "/checkpoint");
  runs.options.replace = false;
  const auto expect_refused = [&](const char* why) {
    try {
      runs.finish(true);
      ADD_FAILURE() << "discarded: " << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << why;
      EXPECT_EQ(error.file(), runs.partial()) << why;
      EXPECT_NE(error.hint().find("--force"), std::string::npos) << error.hint();
    }
    EXPECT_EQ(read_file(runs.partial() + "/checkpoint"), checkpoint) << why;
  };
  runs.set_function("x");
  expect_refused("another function");
  runs.set_function("z");
  const auto denoise = std::exchange(runs.options.denoise, 0.5);
  expect_refused("another option");
  runs.options.denoise = denoise;
  EXPECT_EQ(runs.finish(true), expected);
}

// The checkpoint is not what failed.
TEST(Resume, KeepsTheCheckpointWhereALimitOfTheSystemEndsIt) {
  const std::system_error no_thread(std::make_error_code(std::errc::resource_unavailable_try_again));
  const std::runtime_error of_tbb("pthread_create has failed");
  for (const std::exception* failure :
       {static_cast<const std::exception*>(&no_thread), static_cast<const std::exception*>(&of_tbb)}) {
    Runs runs(grid_mesh(60, 60));
    runs.options.chunk_triangles = 500;
    const std::string expected = runs.finish(false);
    ASSERT_TRUE(runs.stop_after(3, false));
    runs.watch = [&] {
      if (failure == &no_thread) throw no_thread;
      throw of_tbb;
    };
    try {
      runs.finish(true);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kResource) << error.what();
      EXPECT_NE(error.hint().find("ulimit"), std::string::npos) << error.hint();
      EXPECT_NE(error.hint().find("--resume"), std::string::npos) << error.hint();
    }
    EXPECT_TRUE(PartialFolder::has_checkpoint(runs.output()));
    runs.watch = {};
    EXPECT_EQ(runs.finish(true), expected);
  }
}

TEST(Resume, KeepsTheCheckpointWhereNoMoreFilesCanBeOpened) {
  Runs runs(grid_mesh(60, 60));
  runs.options.chunk_triangles = 500;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(3, false));
  const std::string checkpoint = read_file(runs.partial() + "/checkpoint");
  for (std::uint64_t n = 1;; ++n) {
    const FaultAtCall fault(io::FileCall::kOpen, n, {.error = EMFILE});
    {
      const io::ScopedFileFaults faults(fault);
      try {
        runs.finish(true);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kResource) << error.what();
      }
    }
    if (fault.count() < n) break;
    ASSERT_EQ(read_file(runs.partial() + "/checkpoint"), checkpoint) << "after a fault in call " << n;
  }
}

TEST(Resume, KeepsTheCheckpointWhoseFilesCannotBeRead) {
  Runs runs(grid_mesh(250, 250), Form::kBinary, "random:1");
  runs.options.graph_only = true;  // the least budget has no room for the second stage
  runs.options.memory_bytes = 16 << 20;
  runs.options.chunk_triangles = 4096;
  runs.options.threads = 1;
  const std::string expected = runs.finish(false);
  ASSERT_TRUE(runs.stop_after(24, false));
  const fs::path kept = runs.partial() + ".kept";
  fs::rename(runs.partial(), kept);
  const std::string checkpoint = read_file(kept / "checkpoint");
  const std::set<std::string> all = {"checkpoint", "function-0.nodes", "function-0.arcs"};
  const auto keep_again = [&] {
    fs::remove_all(runs.partial());
    fs::copy(kept, runs.partial());
  };
  // Unless the output may be replaced, the checkpoint is read once more before: to see whether it may be discarded.
  struct Fault {
    io::FileCall call;
    int error;
    bool replace;
  };
  for (const auto& [call, error_number, replace] :
       {Fault{io::FileCall::kOpen, EMFILE, true}, Fault{io::FileCall::kOpen, EIO, false},
        Fault{io::FileCall::kRead, EIO, true}, Fault{io::FileCall::kRead, EIO, false}}) {
    runs.options.replace = replace;
    std::set<std::string> failed;
    for (std::uint64_t n = 1; n < 1000 && failed != all; ++n) {
      SCOPED_TRACE(testing::Message() << "error " << error_number << " in call " << n);
      keep_again();
      const FaultAtCall fault(call, n, {.error = error_number}, FaultAtCall::Which::kOne);
      try {
        const io::ScopedFileFaults faults(fault);
        runs.finish(true);
        if (fault.count() < n) break;
        continue;
      } catch (const Error& error) {
        const fs::path file = error.file();
        if (file.parent_path() != runs.partial()) continue;
        if (!failed.insert(file.filename().string()).second) continue;
        EXPECT_EQ(error.kind(), ErrorKind::kResource) << error.what();
        EXPECT_NE(error.hint().find("--resume"), std::string::npos) << error.hint();
      }
      ASSERT_EQ(read_file(runs.partial() + "/checkpoint"), checkpoint);
      Notes notes;
      ASSERT_EQ(runs.finish(true, notes), expected);
      EXPECT_NE(notes.at(0).find("continues from there"), std::string::npos) << notes[0];
    }
    EXPECT_EQ(failed, all);
  }
  // One that is missing will not come back.
  keep_again();
  fs::remove(runs.partial() + "/function-0.arcs");
  Notes notes;
  EXPECT_EQ(runs.finish(true, notes), expected);
  EXPECT_NE(notes.at(0).find("damaged or missing"), std::string::npos) << notes[0];
}

TEST(Resume, GoesOnAfterTheMeshCouldNotBeRead) {
  std::size_t in_run = 0;
  for (const Form form : kForms) {
    SCOPED_TRACE(name_of(form));
    Runs runs(grid_mesh(60, 60), form);
    runs.options.chunk_triangles = 500;
    const std::string expected = runs.finish(false);
    ASSERT_TRUE(runs.stop_after(3, false));
    std::string bytes;
    for (std::uint64_t n = 1; bytes.empty(); ++n) {
      ASSERT_LT(n, 1000u);
      SCOPED_TRACE(testing::Message() << "read " << n);
      try {
        const io::ScopedFileFaults faults(
            FaultAtCall(io::FileCall::kRead, n, {.error = EIO}, FaultAtCall::Which::kOne));
        bytes = runs.finish(true);
      } catch (const Error& error) {
        ASSERT_TRUE(PartialFolder::has_checkpoint(runs.output())) << error.what();
        if (error.file() != runs.mesh_path()) continue;
        EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << error.what();
        in_run += error.hint().find("the same command with --resume") != std::string::npos ? 1u : 0u;
      }
    }
    EXPECT_EQ(bytes, expected);
  }
  EXPECT_GE(in_run, 4u);
}

TEST(Resume, SaysThatThereIsNothingToResume) {
  Runs runs(grid_mesh(20, 20));
  Notes notes;
  runs.finish(true, notes);
  EXPECT_NE(notes.at(0).find("nothing to resume"), std::string::npos) << notes[0];
}

TEST(Resume, KeepsCheckpointsAlongTheWayOnlyWhenTheyAreDue) {
  for (const double seconds : {0.0, 1000.0}) {
    Runs runs(grid_mesh(60, 60));
    runs.options.chunk_triangles = 500;
    runs.options.checkpoint_seconds = seconds;
    std::uint64_t seen = 0;
    const std::string output = runs.output();
    // Like a process that is killed: a copy of the folder is all that remains of it.
    std::string last;
    runs.watch = [&] {
      if (PartialFolder::has_checkpoint(output)) ++seen, last = read_file(runs.partial() + "/checkpoint");
    };
    const std::string expected = runs.finish(false);
    EXPECT_EQ(seen > 5, seconds == 0);
    if (seconds != 0) continue;
    runs.watch = {};
    fs::create_directory(runs.partial());
    write_file(runs.partial() + "/reeb-partial", "");
    write_file(runs.partial() + "/checkpoint", last);
    Notes notes;
    EXPECT_EQ(runs.finish(true, notes), expected);
    EXPECT_NE(notes.at(0).find("continues from there"), std::string::npos) << notes[0];
  }
}

// After a power failure there is the checkpoint before or the whole new one: first the names of the files that it needs
// are on the device, then its content, then its name.
TEST(Resume, ACheckpointIsOnTheDeviceBeforeItHasItsName) {
  const Scratch scratch;
  std::string calls;
  const io::ScopedFileFaults faults([&calls](io::FileCall call) {
    if (call == io::FileCall::kWrite) calls += 'w';
    if (call == io::FileCall::kSync) calls += 's';
    if (call == io::FileCall::kRename) calls += 'r';
    return io::FileFault{};
  });
  write_checkpoint(scratch.path() + "/checkpoint", {}, Checkpoint{}, [&calls](StateWriter&) { calls += '|'; });
  EXPECT_EQ(calls, "|swsrs");
}

TEST(PartialFolder, BelongsToOneRunAtATime) {
  const Scratch scratch;
  const std::string output = scratch.path() + "/a.reeb";
  {
    const PartialFolder folder(output);
    EXPECT_THROW(PartialFolder{output}, Error);
  }
  EXPECT_TRUE(scratch.empty());
}

TEST(PartialFolder, LeavesFilesOfOtherOriginAlone) {
  const Scratch scratch;
  const std::string output = scratch.path() + "/a.reeb", partial = PartialFolder::path_for(output);
  const std::vector<std::string> ours = {"checkpoint.partial-12-0", "function-0.arcs", "function-10.nodes"};
  const std::vector<std::string> others = {
      "notes.txt",          "checkpoints",      "checkpoint.old", "function-.arcs",        "mine.arcs",
      "function-0.arcs.gz", "function-a.nodes", "my.nodes",       "checkpoint.partial-12", "xfunction-0.arcs"};
  for (int run = 0; run < 2; ++run) {
    PartialFolder folder(output);
    for (const std::string& name : ours) write_file(folder.file(name), "left");
    for (const std::string& name : others) write_file(folder.file(name), "mine");
    if (run == 0) folder.clear();
  }
  for (const std::string& name : ours) EXPECT_FALSE(fs::exists(partial + "/" + name)) << name;
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(partial + "/" + name)) << name;
  for (const std::string& name : others) fs::remove(partial + "/" + name);
  { const PartialFolder folder(output); }
  EXPECT_TRUE(scratch.empty());
}

TEST(PartialFolder, RefusesWhatNoRunHasMade) {
  const Scratch scratch;
  const std::string output = scratch.path() + "/a.reeb", partial = PartialFolder::path_for(output);
  const auto expect_refused = [&] {
    try {
      const PartialFolder folder(output);
      ADD_FAILURE() << "accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kResource);
      EXPECT_EQ(e.file(), partial);
      EXPECT_NE(e.hint().find("move it away"), std::string::npos);
    }
  };
  fs::create_directory(partial);
  write_file(partial + "/function-0.arcs", "mine");
  expect_refused();
  // A link with the name of the mark is not a mark.
  fs::create_symlink(partial + "/function-0.arcs", partial + "/reeb-partial");
  expect_refused();
  EXPECT_EQ(read_file(partial + "/function-0.arcs"), "mine");
  fs::rename(partial, scratch.path() + "/elsewhere");
  fs::create_symlink(scratch.path() + "/elsewhere", partial);
  expect_refused();
  EXPECT_EQ(read_file(scratch.path() + "/elsewhere/function-0.arcs"), "mine");
}

// Others could replace its files by links at any moment.
TEST(PartialFolder, RefusesWhatOthersMayWrite) {
  const Scratch scratch;
  const std::string output = scratch.path() + "/a.reeb", partial = PartialFolder::path_for(output);
  for (const fs::perms more : {fs::perms::group_write, fs::perms::others_write}) {
    fs::create_directory(partial);
    write_file(partial + "/reeb-partial", "");
    write_file(partial + "/checkpoint", "mine");
    fs::permissions(partial, fs::perms::owner_all | more);
    EXPECT_THROW(PartialFolder{output}, Error);
    EXPECT_EQ(read_file(partial + "/checkpoint"), "mine");
    fs::remove_all(partial);
  }
}

TEST(PartialFolder, IsForThisUserOnly) {
  const Scratch scratch;
  const PartialFolder folder(scratch.path() + "/a.reeb");
  EXPECT_EQ(fs::status(folder.path()).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(folder.file("reeb-partial")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
}  // namespace reeb::ooc
