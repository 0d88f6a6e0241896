// Options of the command line that take sizes and counts.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <string>

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

}  // namespace reeb::tools
