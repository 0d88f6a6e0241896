// What the commands share that run a mesh: options, and what they print meanwhile.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "libreeb/port/mesh_reader.h"
#include "tools/arguments/arguments.h"
#include "tools/library/compute.h"
#include "tools/program/progress.h"

namespace reeb::tools {

struct RunArguments {
  RunArguments();

  std::string mesh, denoise;
  std::vector<std::string> functions;
  ComputeOptions options;
  bool quiet = false;
};

// What the help says of --memory and --threads.
struct RunTexts {
  const char* memory = "Memory that the run may use: 64M, 1.5GiB (default: no limit)";
  const char* threads = "Number of threads, 1 to 1024 (default: all, or 1 for a small mesh)";
};

// `arguments` must outlive the parsing.
void add_run_options(Command command, RunArguments& arguments, const RunTexts& texts = {});
// Refuses the options that need a whole mesh, and says why.
void refuse_whole_mesh_options(Command command);
// Turns the text of --denoise into options. THROWS: Error{kUsage}.
void take_denoise(RunArguments& arguments);

// The output itself; of several functions, an output of each: OUT-FUNC, with the suffix.
// THROWS: Error{kUsage} if several would go to standard output or a device.
std::vector<std::string> output_names(std::filesystem::path output, const std::vector<std::string>& functions,
                                      std::string_view suffix = ".reeb");
// THROWS: Error{kBadInput} if a function is given twice.
void check_functions(const std::vector<std::string>& functions);
// Checks the files of a run before it begins, with its report (empty: none), which compute() does not know.
// THROWS: as RunFiles::check().
void check_files(const RunArguments& arguments, const std::vector<std::string>& outputs, const std::string& report);

// "PLY binary little endian, 5 vertices, 6 faces"
std::string describe(const MeshInfo& info);
ProgressBar::Pass pass_of(ComputeProgress::Phase phase);

}  // namespace reeb::tools
