#include "ooc/distributed/compute_part.h"

#include <array>

#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "libreeb/base/error.h"
#include "ooc/distributed/fragment_file.h"
#include "ooc/distributed/names_file.h"
#include "ooc/distributed/part_run.h"
#include "ooc/run/explained_error.h"

namespace reeb::ooc {
namespace {

// The run of another share cannot be resumed by this one.
std::uint64_t reading_of_share(std::uint64_t reading, const PartChoice& choice) {
  const std::array<std::uint64_t, 3> numbers = {reading, choice.part, choice.parts};
  return io::checksum(std::as_bytes(std::span(numbers)));
}

// Whatever goes wrong with an input that changes is due to the change.
template <class Work>
auto with_explained_errors(RunContext& run, const std::string& mesh, const Work& work) {
  try {
    try {
      return work();
    } catch (Error& error) {
      run.check_inputs();
      if (error.cause() == ErrorCause::kChanged) error.at(mesh);
      throw;
    } catch (const std::exception&) {
      run.check_inputs();
      throw;
    }
  } catch (...) {
    throw_explained(run);
  }
}

// Other parts take their triangles from where sizes tell, so this one cannot count them instead.
std::uint64_t write_names_of(WholeMesh& mesh, const std::string& output, RunContext& run, std::uint32_t part,
                             const std::string& path) {
  try {
    return write_names(output, run.output_options(), run, mesh, part);
  } catch (const Error& error) {
    if (!mesh.by_size || error.kind() != ErrorKind::kBadInput) throw;
    const std::uint64_t by_size = mesh.info.shares.triangles;
    count_triangles(run, mesh);
    if (mesh.info.shares.triangles == by_size) throw;
    throw Error(ErrorKind::kBadInput,
                "not all of its faces are triangles, although together they have the size of triangles",
                "compute the parts without --scan and --shared")
        .at(path);
  }
}

}  // namespace

std::vector<FragmentResult> compute_part(MeshInput input, std::span<VertexFunction* const> functions,
                                         std::span<const std::string> outputs, const ComputeOptions& options,
                                         const PartChoice& choice) {
  for (const std::string& output : outputs) io::require_output_folder(output);
  const std::uint64_t reading = input.reading;
  input.reading = reading_of_share(reading, choice);
  const ComputeOptions run_options = options_of_share(options);
  RunContext run(input, functions, outputs, run_options);
  input.reading = reading;
  const std::string path = input.path;
  return with_explained_errors(run, path, [&] {
    WholeMesh mesh = open_whole_mesh(run, input, choice.parts);
    PartUses uses = choice.shared.empty() ? find_part_uses(run, input, mesh) : read_names(choice.shared, run, mesh);
    PartResult done = run_part(run, input, mesh, uses, choice.part, options);
    std::vector<FragmentResult> results;
    for (std::size_t f = 0; f < functions.size(); ++f) {
      const auto& [info, open, memory] = done.parts[f];
      write_fragment(outputs[f], run.output_options(), info, open, *run.stores[f]);
      results.push_back({info, outputs[f], open_vertices_of(open), done.seconds, done.notes});
    }
    run.resumable.done();
    return results;
  });
}

std::uint64_t scan_part(MeshInput input, std::span<VertexFunction* const> functions, const std::string& output,
                        const ComputeOptions& options, const PartChoice& choice) {
  io::require_output_folder(output);
  const std::string path = input.path;
  input.may_resume = false;
  const ComputeOptions run_options = options_of_share(options);
  RunContext run(input, functions, std::span(&output, 1), run_options);
  return with_explained_errors(run, path, [&] {
    io::remove_abandoned(output);
    WholeMesh mesh = open_whole_mesh(run, input, choice.parts);
    return write_names_of(mesh, output, run, choice.part, path);
  });
}

}  // namespace reeb::ooc
