// Options of the command line that several commands have.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>

#include "io/formats/format_names.h"
#include "tools/program/quantity.h"

namespace reeb::tools {

// `names` as CLI11 has them ("--chunk"); `target` must outlive the parsing.
template <class Target>
CLI::Option* add_count(CLI::App& command, const std::string& name, Target& target, const std::string& description,
                       CountLimits limits = {}) {
  return command
      .add_option_function<std::string>(
          name,
          [name, &target, limits](const std::string& text) {
            target = static_cast<Target>(parse_count(name, text, limits));
          },
          description)
      ->type_name("N");
}

template <class Target>
CLI::Option* add_size(CLI::App& command, const std::string& name, Target& target, const std::string& description) {
  return command
      .add_option_function<std::string>(
          name, [name, &target](const std::string& text) { target = parse_size(name, text); }, description)
      ->type_name("SIZE");
}

// `--format NAME`, for commands that read a mesh.
inline CLI::Option* add_format(CLI::App& command, std::string& target) {
  return command
      .add_option_function<std::string>(
          "--format",
          [&target](const std::string& name) {
            io::check_format_name(name);
            target = name;
          },
          "Format, where content and name do not tell: ply obj off stl sma smb smc sva svb cx vtk vtu vtp msh medit "
          "tetgen nrrd nifti mha vti npy asc raw")
      ->type_name("NAME");
}

}  // namespace reeb::tools
