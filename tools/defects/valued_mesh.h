// A mesh that is read repeatedly, with the values of some functions.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/file/content_source.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_spec.h"
#include "io/functions/mesh_field.h"
#include "libreeb/port/indexed_mesh.h"
#include "ooc/whole_mesh/workspace.h"

namespace reeb::tools {

struct MeshSource {
  std::string path, format, temp_folder;
  std::uint64_t memory_bytes = ~std::uint64_t{0};
  io::ImageOptions image = {};
  std::function<bool()> interrupted{};  // asked while the mesh is read; true ends the run

  // THROWS: Error{kInterrupted}.
  void check_interruption() const;
};

class ValuedMesh {
 public:
  // `source` must outlive this. THROWS: Error of the reader, and of functions that the mesh does not have.
  ValuedMesh(const MeshSource& source, std::span<const std::string> functions);

  const MeshInfo& info() const { return info_; }
  const std::string& path() const { return source_.path; }
  std::uint64_t memory_bytes() const { return source_.memory_bytes; }
  const std::string& temp_folder() const { return source_.temp_folder; }

  // Reads all of it, and asks whether it is interrupted. `values[k]` are those of function k at the vertices of the
  // batch; `done` of `total` bytes.
  using Observe = std::function<void(const MeshBatch& batch, std::span<const std::vector<double>> values,
                                     std::uint64_t done, std::uint64_t total)>;
  void read(const Observe& observe) const;
  // Gives its triangles, with random access to its vertices; a format without that is copied to the disk first.
  void look_up(ooc::Workspace& space, const std::function<void(IndexedMesh&)>& use) const;

 private:
  std::unique_ptr<MeshReader> open() const;

  const MeshSource& source_;
  io::Input input_;
  std::vector<io::FunctionSpec> specs_;
  std::vector<std::string> properties_;
  std::vector<io::MeshField> fields_;
  MeshInfo info_;
};

// THROWS: Error{kBadInput}.
[[noreturn]] void refuse_cells(const std::string& mesh, bool is_image);

}  // namespace reeb::tools
