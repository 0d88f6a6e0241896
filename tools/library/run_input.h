// A mesh and its functions, opened for a run.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/file/content_source.h"
#include "io/formats/open_mesh.h"
#include "io/functions/function_source.h"
#include "io/functions/mesh_field.h"
#include "ooc/run/compute.h"
#include "tools/library/compute.h"

namespace reeb {

struct InputOptions {
  std::string format{};
  io::ImageOptions image{};
  std::string temp_dir;  // not empty
  std::uint64_t memory_bytes = ~std::uint64_t{0};
  std::size_t batch_events = 8192;  // a few hundred KiB, beside chunks on their way
};

// By the number of cells, or else of bytes.
ooc::MeshSize size_of(const MeshInfo& info);

// Temporary files go to `temp_dir` of the options; if that is empty, to the default folder for `output`.
InputOptions input_options(const ComputeOptions& options, const std::string& output);

// Functions as users name them; "" is the default of the mesh.
// THROWS: Error{kUsage} for an unknown function.
std::vector<io::FunctionSpec> parse_functions(std::span<const std::string> functions);

// THROWS: Error{kBadInput} if a function is the value of an image and the file is a mesh, as far as its content tells.
void refuse_value_of_mesh(const io::Input& input, std::span<const io::FunctionSpec> specs, const std::string& format,
                          const io::ImageOptions& image);

// Must outlive the run.
class RunInput {
 public:
  // `functions` as users name them; "" is the default of the mesh.
  // THROWS: Error, of the mesh or of a function.
  RunInput(const std::string& path, std::span<const std::string> functions, const InputOptions& options);
  // A mesh that the caller holds. Of the options, format and image have no effect.
  RunInput(MeshOpener open, std::span<const std::string> functions, const InputOptions& options);

  const MeshInfo& info() const { return info_; }
  // The reader alone, for a run with snapshots; or the mesh in the form that suits a run best. To be taken once.
  ooc::MeshInput take_reader() { return std::move(mesh_); }
  ooc::MeshInput take_mesh();
  const std::vector<VertexFunction*>& functions() const { return functions_; }
  // What was noticed while the functions were prepared.
  const std::vector<std::string>& notes(std::size_t function) const { return fields_[function].notes; }
  // Opens the mesh another time, in the same way; or with vertices numbered 0, 1, 2, ... even if some vertices of an
  // image are left out. REQUIRES: can_read_again().
  bool can_read_again() const { return !file_ || file_->can_reopen(); }
  std::unique_ptr<MeshReader> read_again(const ReadOptions& options, bool renumber = false) const;
  // REQUIRES: the mesh is in a file.
  const io::Input& input() const { return *file_; }

 private:
  void open(std::span<const std::string> functions, std::unique_ptr<io::ContentSource> content);

  InputOptions options_;
  std::optional<io::Input> file_;
  MeshOpener held_;  // empty if the mesh is in a file
  ReadOptions reading_;
  MeshInfo info_;
  ooc::MeshInput mesh_;
  std::vector<io::MeshField> fields_;
  std::vector<std::unique_ptr<io::FunctionSource>> sources_;
  std::vector<VertexFunction*> functions_;
};

}  // namespace reeb
