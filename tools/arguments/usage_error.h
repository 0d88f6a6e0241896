// What is wrong with a command line, in the words of a person. For arguments.cpp only: it includes CLI11.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "libreeb/base/error.h"

namespace reeb::tools {

// The command of this name; null if there is none.
const CLI::App* find_command(const CLI::App& program, const std::string& name);

// For words, the first of which is a command, that CLI11 refused.
Error usage_error(const CLI::App& program, const std::vector<std::string>& words, const CLI::ParseError& refusal);

}  // namespace reeb::tools
