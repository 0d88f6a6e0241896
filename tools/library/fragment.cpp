#include "tools/library/fragment.h"

#include "libreeb/base/error.h"
#include "tools/library/run_files.h"
#include "tools/library/run_input.h"
#include "tools/library/run_options.h"

namespace reeb {
namespace {

void check_files(const std::string& path, std::span<const std::string> functions, std::span<const std::string> outputs,
                 const ComputeOptions& options, const ooc::PartChoice& choice) {
  check_limits(options);
  if (path == "-")
    throw Error(ErrorKind::kUsage, "a part of standard input cannot be computed, since other parts need the mesh, too",
                "name the file of the mesh");
  RunFiles files = files_of_run(path, parse_functions(functions), outputs, options);
  for (const std::string& names : choice.shared) files.add_input(names, "a file of names");
  files.check();
}

}  // namespace

std::vector<ooc::FragmentResult> compute_fragments(const std::string& path, std::span<const std::string> functions,
                                                   std::span<const std::string> outputs, const ComputeOptions& options,
                                                   const ooc::PartChoice& choice) {
  require_an_output_each(functions, outputs);
  check_files(path, functions, outputs, options, choice);
  RunInput input(path, functions, input_options(options, outputs.front()));
  if (options.opened) options.opened(input.info());
  auto results = ooc::compute_part(input.take_mesh(), input.functions(), outputs, run_options(options), choice);
  for (std::size_t f = 0; f < results.size(); ++f)
    results[f].notes.insert(results[f].notes.end(), input.notes(f).begin(), input.notes(f).end());
  return results;
}

std::uint64_t scan_names(const std::string& path, const std::string& output, const ComputeOptions& options,
                         const ooc::PartChoice& choice) {
  const std::string none;  // the default function: names do not depend on it
  check_files(path, std::span(&none, 1), std::span(&output, 1), options, choice);
  RunInput input(path, std::span(&none, 1), input_options(options, output));
  if (options.opened) options.opened(input.info());
  return ooc::scan_part(input.take_mesh(), input.functions(), output, run_options(options), choice);
}

}  // namespace reeb
