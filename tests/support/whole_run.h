// Whole runs, from a mesh in memory to `.reeb` files, for chunks of any size, any number of threads and all forms of
// input. REEB_TEST_MEMORY and REEB_TEST_CHUNK limit them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "ooc/reeb_file/reeb_file.h"
#include "ooc/run/compute.h"
#include "ooc/whole_mesh/piece_order.h"
#include "tests/support/files.h"
#include "tests/support/inputs/complex_mesh.h"
#include "tests/support/inputs/conservation.h"
#include "tests/support/random.h"
#include "tests/support/run_limits.h"
#include "tests/support/scratch.h"

namespace reeb::test {

enum class Form { kIndexed, kSeeminglyClosed, kStream, kUnfinalized, kPieces };
constexpr Form kForms[] = {Form::kIndexed, Form::kSeeminglyClosed, Form::kStream, Form::kUnfinalized};

inline const char* name_of(Form form) {
  constexpr const char* kNames[] = {"Indexed", "SeeminglyClosed", "Stream", "Unfinalized", "Pieces"};
  return kNames[static_cast<std::size_t>(form)];
}

// Indexed, and said to have as many triangles as a closed surface. So guesses are made while it is read in place.
class SeeminglyClosed : public IndexedComplex {
 public:
  using IndexedComplex::IndexedComplex;
  std::optional<std::uint64_t> triangles_by_size() const override { return 2 * vertex_count(); }
};

// Cut into pieces of random lengths, in random order.
inline std::unique_ptr<IndexedMesh> in_random_pieces(const ComplexMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  const std::size_t most = 1 + random.below(10), count = mesh.triangles.size() / 3;
  ooc::MeshPieces pieces;
  for (std::size_t at = 0; at < count;) {
    const std::size_t length = std::min(count - at, 1 + random.below(most));
    pieces.pieces.push_back(
        {.place = {3 * at, 0}, .rank = 0, .centre = {}, .triangles = static_cast<std::uint32_t>(length)});
    at += length;
  }
  for (std::size_t i = pieces.pieces.size(); i > 1; --i)
    std::swap(pieces.pieces[i - 1], pieces.pieces[random.below(i)]);
  return std::make_unique<ooc::PiecewiseMesh>(std::make_unique<IndexedComplex>(mesh), std::move(pieces));
}

struct RunShape {
  std::size_t chunk_triangles;  // 0: adaptive
  unsigned threads;
  Form form;
  std::size_t stretch_triangles = 0;
};

inline std::ostream& operator<<(std::ostream& out, const RunShape& shape) {
  return out << "chunk " << shape.chunk_triangles << " of " << shape.stretch_triangles << ", threads " << shape.threads
             << ", " << name_of(shape.form);
}

inline std::vector<std::size_t> all_chunk_sizes() {
  if (const auto limit = chunk_limit()) return {static_cast<std::size_t>(*limit)};
  return {1, 7, 1000, 65536, 0};
}

inline std::vector<RunShape> all_shapes() {
  std::vector<RunShape> shapes;
  for (const std::size_t chunk : all_chunk_sizes())
    for (const unsigned threads : {1u, 2u, 4u})
      for (const Form form : kForms) {
        shapes.push_back({chunk, threads, form});
        // Chunks are cut from stretches, as for wide fronts.
        if (chunk != 0 && chunk <= 7) shapes.push_back({chunk, threads, form, 20 * chunk});
      }
  return shapes;
}

// A run syncs its output to disk, and many small runs would wait for that most of the time. So scratch folders are in
// memory where the system has such a folder.
inline const bool scratch_is_in_memory =
    ::access("/dev/shm", W_OK) == 0 && ::setenv("TMPDIR", "/dev/shm", /*overwrite=*/0) == 0;

// Runs of `compute` on one mesh. Each works in a folder that is empty before and after, and loses no vertex.
class Runner {
 public:
  explicit Runner(bool graph_only = false) { options_.graph_only = graph_only; }

  // Applies to the runs after this call.
  ooc::ComputeOptions& options() { return options_; }
  // The output file of the function that is this column of the mesh.
  std::string output(unsigned column) const { return outputs_.path() + "/" + ColumnFunction(column).name() + ".reeb"; }

  // The outputs of the functions that are these columns of the mesh, in one run.
  std::vector<std::string> run(const ComplexMesh& mesh, const RunShape& shape, std::vector<unsigned> columns = {3},
                               std::uint64_t seed = 1) {
    std::vector<ColumnFunction> functions(columns.begin(), columns.end());
    std::vector<VertexFunction*> pointers;
    std::vector<std::string> outputs;
    for (ColumnFunction& function : functions) {
      pointers.push_back(&function);
      outputs.push_back(outputs_.path() + "/" + function.name() + ".reeb");
    }
    ooc::MeshInput input;
    if (shape.form == Form::kStream) {
      input.read_again = [&mesh, seed] { return std::make_unique<ComplexStream>(mesh, seed); };
      input.reader = input.read_again();
    } else if (shape.form == Form::kUnfinalized) {
      input.reader = std::make_unique<UnfinalizedComplex>(mesh, seed);
    } else if (shape.form == Form::kPieces) {
      input.indexed = in_random_pieces(mesh, seed);
    } else if (shape.form == Form::kSeeminglyClosed) {
      input.indexed = std::make_unique<SeeminglyClosed>(mesh);
    } else {
      input.indexed = std::make_unique<IndexedComplex>(mesh);
    }
    ooc::ComputeOptions options = options_;
    options.chunk_triangles = shape.chunk_triangles;
    options.stretch_triangles = shape.stretch_triangles;
    options.threads = shape.threads;
    options.temp_dir = temp_.path();
    options.memory_bytes = memory_limit().value_or(options_.memory_bytes);
    results_ = ooc::compute(std::move(input), pointers, outputs, options);
    EXPECT_TRUE(temp_.empty()) << "temporary files were left";
    for (const std::string& output : outputs) {
      SCOPED_TRACE(testing::Message() << "conservation: " << shape);
      const ooc::ReebFile file(output);
      EXPECT_EQ(file.header().flags.has_embedding, options.buckets != 0);
      expect_vertices_conserved(file);
    }
    return outputs;
  }

  const std::vector<ooc::ComputeResult>& results() const { return results_; }

 private:
  ooc::ComputeOptions options_;
  ooc::Scratch outputs_, temp_;
  std::vector<ooc::ComputeResult> results_;
};

// Reads and removes it.
inline std::string take_bytes(const std::string& path) {
  std::string bytes = read_file(path);
  std::filesystem::remove(path);
  return bytes;
}

inline ReebGraph take_graph(const std::string& path) {
  ReebGraph graph = ooc::ReebFile(path).load().graph;
  std::filesystem::remove(path);
  return graph;
}

}  // namespace reeb::test
