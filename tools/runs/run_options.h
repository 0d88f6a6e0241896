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

// `arguments` must outlive the parsing.
void add_run_options(Command command, RunArguments& arguments);
// Turns the text of --denoise into options. THROWS: Error{kUsage}.
void take_denoise(RunArguments& arguments);

// "PLY binary little endian, 5 vertices, 6 faces"
std::string describe(const MeshInfo& info);
ProgressBar::Pass pass_of(ComputeProgress::Phase phase);

}  // namespace reeb::tools
