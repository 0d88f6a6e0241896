// What is wrong with a command line, in the words of a person.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "libreeb/base/error.h"

namespace reeb::tools {

// The command of this name; null if there is none.
const CLI::App* find_command(const CLI::App& program, const std::string& name);

// The names of the commands, "compute, info, ...".
std::string command_names(const CLI::App& program);

// The one of `names` that differs least from `word`; empty if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& names);

// For a first word that is neither a command nor a file.
Error no_such_command(const CLI::App& program, const std::string& word);

// For words, the first of which is a command, that CLI11 refused.
Error usage_error(const CLI::App& program, const std::vector<std::string>& words, const CLI::ParseError& refusal);

}  // namespace reeb::tools
