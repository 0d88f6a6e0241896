// What the commands share that run a mesh: options, and what they print meanwhile.
#pragma once

#include <string>
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
// Turns the text of --denoise into options. THROWS: Error{kUsage}.
void take_denoise(RunArguments& arguments);

// "PLY binary little endian, 5 vertices, 6 faces"
std::string describe(const MeshInfo& info);
ProgressBar::Pass pass_of(ComputeProgress::Phase phase);

}  // namespace reeb::tools
