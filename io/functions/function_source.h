// The values of a function at the vertices of a mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/functions/function_spec.h"
#include "libreeb/port/mesh_reader.h"
#include "libreeb/port/vertex_function.h"

namespace reeb::io {

class ValueFile;
struct MeshField;

// The value of `random:SEED` at a vertex, in [0, 1).
double random_value(std::uint64_t seed, std::uint64_t vertex) noexcept;

// One function, for the vertices of a stream in order or for any vertices by index. Values are finite, and -0.0 becomes
// 0.0.
class FunctionSource final : public VertexFunction {
 public:
  // `properties` is the ReadOptions::properties with which the mesh was opened; `field` is what read_fields() found for
  // this function. Users of the library get a function that needs one from compute() only.
  // REQUIRES: a field, if spec.needs_field().
  // THROWS: Error{kBadInput}: the mesh (`mesh_name`) does not have the coordinate or property; the file cannot be read,
  //         or is known not to have one value per vertex.
  FunctionSource(const FunctionSpec& spec, const MeshInfo& info, std::span<const std::string> properties = {},
                 std::string mesh_name = {}, const MeshField* field = nullptr);
  ~FunctionSource() override;

  std::string name() const override { return spec_.text; }
  std::string source_file() const override;
  std::span<const unsigned> columns() const override;
  bool needs_lookup() const override { return spec_.kind == FunctionSpec::Kind::kDistanceToVertex && center_.empty(); }
  void look_up(IndexedMesh& mesh) override;
  // The same by reading the mesh from its beginning, as far as needed.
  void look_up(MeshReader& reader);
  void check_count(std::uint64_t vertex_count) override;
  void check_unchanged() const override;
  std::uint64_t lookup_bytes(std::uint64_t vertex_count) const override;
  // A text file is read into memory for this, unless all calls together go through the vertices once, in order.
  void evaluate(std::span<const VertexId> ids, std::span<const std::span<const double>> columns,
                std::span<double> values) override;

  // The values of the vertices of a batch, in order. REQUIRES: values.size() == batch.vertex_count, and batches are
  // passed in order.
  // THROWS: Error{kBadInput} that names the vertex, if a value is missing or not finite.
  void evaluate(const MeshBatch& batch, std::span<double> values);

 private:
  double value_of(std::uint64_t vertex);
  [[noreturn]] void fail_no_vertex(std::uint64_t vertex_count) const;
  // What a file of values has: also for vertices that are left out.
  std::uint64_t value_count(std::uint64_t vertex_count) const { return number_count_.value_or(vertex_count); }
  bool is_distance() const {
    return spec_.kind == FunctionSpec::Kind::kDistanceToVertex || spec_.kind == FunctionSpec::Kind::kDistanceToPoint;
  }
  // `column(k)` is coordinate k, of as many vertices as there are values.
  template <class Column>
  void measure_distances(const Column& column, std::span<double> values) const;
  void copy_finite(std::span<const double> from, std::span<double> to, std::span<const VertexId> ids,
                   std::uint64_t first) const;
  void check_finite(std::span<const double> values, std::span<const VertexId> ids, std::uint64_t first) const;

  FunctionSpec spec_;
  std::string mesh_name_;
  std::optional<std::uint64_t> number_count_;  // as in MeshInfo
  std::vector<unsigned> columns_;              // of the mesh: the function itself, or the coordinates of a distance
  std::vector<double> center_;                 // from which distances are measured
  std::unique_ptr<ValueFile> file_;
};

}  // namespace reeb::io
