#include "io/functions/mesh_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "io/fields/geodesic.h"
#include "io/fields/laplacian.h"
#include "io/fields/whole_complex.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/count_text.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::io {
namespace {

using Kind = FunctionSpec::Kind;

[[noreturn]] void fail_vertex(const std::string& function, std::uint64_t vertex, const WholeComplex& complex,
                              const std::string& mesh_name) {
  const std::string names = function + " names vertex " + std::to_string(vertex) + ", ";
  if (vertex < complex.number_count)
    throw Error(ErrorKind::kBadInput, names + "which has no data and is skipped", "name a vertex that has data")
        .at(mesh_name);
  throw Error(ErrorKind::kBadInput, names + "but the mesh has " + count_of(complex.vertex_count(), "vertex"),
              "vertices are numbered from 0")
      .at(mesh_name);
}

// By the numbers of the vertices; those that are left out have 0.
std::shared_ptr<const InputFile> to_file(const std::vector<double>& values, const WholeComplex& complex,
                                         const TempDir& temp) {
  File file = temp.create_unnamed("values");
  const VertexNumbering& numbers = complex.numbers;
  const auto all = std::span(values);
  for (std::size_t first = 0, count = 0; first < all.size(); first += count) {
    const std::uint64_t number = numbers.number_of(first);
    count = static_cast<std::size_t>(numbers.run_from(first));
    file.write_at(8 * number, std::as_bytes(all.subspan(first, count)));
  }
  const double none = 0;
  if (numbers.end() < complex.number_count)
    file.write_at(8 * (complex.number_count - 1), std::as_bytes(std::span(&none, 1)));
  return std::make_shared<const InputFile>(std::move(file));
}

std::vector<double> geodesic_values(const FunctionSpec& spec, const WholeComplex& complex, const std::string& mesh_name,
                                    MemoryBudget& budget) {
  std::vector<std::uint32_t> sources;
  for (const std::uint64_t vertex : spec.vertices) {
    const auto index = complex.numbers.index_of(vertex);
    if (!index) fail_vertex(spec.text, vertex, complex, mesh_name);
    sources.push_back(static_cast<std::uint32_t>(*index));
  }
  std::vector<double> values = geodesic_distance(complex, sources, budget);
  const auto unreached = std::ranges::find_if(values, [](double value) { return std::isinf(value); });
  if (unreached != values.end()) {
    const auto count = static_cast<std::uint64_t>(
        std::count_if(unreached, values.end(), [](double value) { return std::isinf(value); }));
    throw Error(ErrorKind::kBadInput,
                spec.text + " does not reach vertex " +
                    std::to_string(complex.numbers.number_of(static_cast<std::uint64_t>(unreached - values.begin()))) +
                    (count == 1 ? "" : " and " + count_of(count - 1, "other vertex")),
                "name a vertex of each connected component, or choose another function")
        .at(mesh_name);
  }
  return values;
}

std::vector<double> laplacian_values(const FunctionSpec& spec, const WholeComplex& complex, MemoryBudget& budget,
                                     const std::string& mesh_name, std::vector<std::string>& notes) {
  try {
    Eigenvector vector = laplacian_eigenvector(complex, spec.number, budget);
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), " has the eigenvalue %.6g, with a residual of %.1e", vector.eigenvalue,
                  vector.residual);
    notes.push_back(spec.text + text.data());
    if (vector.other_vertices != 0)
      notes.push_back(spec.text + " is 0 at " + count_of(vector.other_vertices, "vertex") +
                      " outside the largest component");
    return std::move(vector.values);
  } catch (Error& error) {
    if (error.file().empty() && error.kind() == ErrorKind::kBadInput) throw error.at(mesh_name);
    throw;
  }
}

}  // namespace

std::vector<MeshField> read_fields(std::span<const FunctionSpec> specs, const OpenMesh& open_mesh,
                                   const std::string& mesh_name, const std::string& temp_folder,
                                   std::uint64_t memory_bytes) {
  constexpr std::uint64_t kProcess = std::uint64_t{12} << 20;
  std::vector<MeshField> fields(specs.size());
  const auto needing = std::ranges::find_if(specs, &FunctionSpec::needs_field);
  if (needing == specs.end()) return fields;
  if (!open_mesh)
    throw Error(ErrorKind::kBadInput,
                needing->text + " reads the mesh before the run does, and this input can be read only once",
                "write the mesh to a file first")
        .at(mesh_name == "-" ? kStandardInputShown : mesh_name);
  const TempDir temp(temp_folder);
  MemoryBudget budget(memory_bytes - (memory_bytes == MemoryBudget::kUnlimited ? 0 : std::min(memory_bytes, kProcess)),
                      kProcess);
  std::optional<WholeComplex> complex;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const FunctionSpec& spec = specs[i];
    if (!spec.needs_field()) continue;
    MeshField& field = fields[i];
    if (!complex) complex = read_whole(*open_mesh(), budget);
    const Reservation memory = budget.reserve("values of the function", std::uint64_t{8} * complex->vertex_count());
    if (spec.kind == Kind::kGeodesic) {
      if (!complex->is_surface)
        field.notes.push_back(spec.text + " follows edges where there are other simplices than triangles");
      field.values = to_file(geodesic_values(spec, *complex, mesh_name, budget), *complex, temp);
    } else {
      field.values = to_file(laplacian_values(spec, *complex, budget, mesh_name, field.notes), *complex, temp);
    }
  }
  return fields;
}

}  // namespace reeb::io
