// Options of the command line that several commands have.
#pragma once

#include <cstdint>
#include <string>

#include "io/formats/format_names.h"
#include "tools/arguments/arguments.h"
#include "tools/program/quantity.h"

namespace reeb::tools {

// `target` must outlive the parsing.
template <class Target>
Option add_count(Command command, const std::string& name, Target& target, const std::string& description,
                 CountLimits limits = {}) {
  return command
      .add_option(
          name,
          [name, &target, limits](const std::string& text) {
            target = static_cast<Target>(parse_count(name, text, limits));
          },
          description)
      .type_name("N");
}

template <class Target>
Option add_size(Command command, const std::string& name, Target& target, const std::string& description) {
  return command
      .add_option(
          name, [name, &target](const std::string& text) { target = parse_size(name, text); }, description)
      .type_name("SIZE");
}

template <class Target>
Option add_memory(Command command, Target& target,
                  const std::string& description = "Memory that the run may use: 64M, 1.5GiB (default: no limit)") {
  return add_size(command, "--memory", target, description);
}

template <class Target>
Option add_threads(Command command, Target& target,
                   const std::string& description = "Number of threads, 1 to 1024 (default: all)") {
  return add_count(command, "--threads", target, description, {.least = 1, .most = 1024});
}

inline Option add_temp_dir(
    Command command, std::string& target,
    const std::string& description = "Folder for temporary files (default: $TMPDIR, or the folder of the output)") {
  return command.add_option("--temp-dir", target, description).type_name("DIR");
}

inline Option add_force(Command command, bool& target, const std::string& description = "Replace an existing output") {
  return command.add_flag("--force", target, description);
}

inline Option add_quiet(Command command, bool& target) {
  return command.add_flag("--quiet", target, "Print no progress, no notes and no summary");
}

// `--format NAME`, for commands that read a mesh. `what` begins the help.
inline Option add_format(Command command, std::string& target, const std::string& what = "Input format") {
  return command
      .add_option(
          "--format",
          [&target](const std::string& name) {
            io::check_format_name(name);
            target = name;
          },
          what +
              ", if content and name do not show it: ply obj off stl sma smb smc sva svb cx vtk vtu vtp msh "
              "medit tetgen nrrd nifti mha vti npy asc raw")
      .type_name("NAME");
}

}  // namespace reeb::tools
