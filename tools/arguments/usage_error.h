// What is wrong with a command line, in the words of a person. For arguments.cpp only: it includes CLI11.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "libreeb/base/error.h"

namespace reeb::tools {

// The command of this name; null if there is none.
const CLI::App* find_command(const CLI::App& program, const std::string& name);

// CLI11 would take the name of an option as the value of the one before, and would call the next word unexpected.
std::optional<Error> missing_value(const CLI::App& program, const std::vector<std::string>& words);

// For words, the first of which is a command, that CLI11 refused.
Error usage_error(const CLI::App& program, const std::vector<std::string>& words, const CLI::ParseError& refusal);

}  // namespace reeb::tools
