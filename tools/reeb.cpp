// The program `reeb`: finds the subcommand, and turns every error into one line, a hint and an exit code (docs/CLI.md).
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "libreeb/base/nearest_name.h"
#include "libreeb/base/printable.h"
#include "ooc/run/explained_error.h"
#include "ooc/run/freed_memory.h"
#include "tools/arguments/arguments.h"
#include "tools/commands/commands.h"
#include "tools/program/process_memory.h"
#include "tools/program/signals.h"
#include "tools/program/standard_streams.h"
#include "tools/runs/fragment_commands.h"

namespace {

int report(reeb::ErrorKind kind, const std::string& what, const std::string& hint) {
  fmt::print(stderr, "reeb: error: {}\nhint: {}\n", reeb::printable(what), reeb::printable(hint));
  return static_cast<int>(kind);
}

// An error that no part of the program explains.
int report(const std::exception& error) {
  const auto limit = reeb::ooc::error_of_limit(error);
  return report(reeb::ErrorKind::kResource, error.what(), limit ? limit->hint() : "please report this as a bug");
}

// Of the system: stdio and fmt throw for standard output only.
int report(const std::system_error& error) {
  if (std::ferror(stdout) != 0)
    return report(reeb::ErrorKind::kResource, "standard output: cannot be written: " + error.code().message(),
                  reeb::io::hint_for(error.code().value(), "check what standard output leads to"));
  return report(static_cast<const std::exception&>(error));
}

constexpr const char* kExamples = R"(Examples:
  reeb scan.ply                     the Reeb graph of the height, as scan.reeb
  reeb scan.ply -f x --memory 64M   another function, in 64 MiB
  reeb extract scan.reeb --nodes 100 -o coarse.dot
                                    the finest level with at most 100 nodes

Every command has --help.)";

struct NamedCommand {
  const char* name;
  void (*add)(reeb::tools::Program& program);
};

// In the order of the help.
constexpr NamedCommand kCommands[] = {
    {"compute", reeb::tools::add_compute},   {"info", reeb::tools::add_info},
    {"extract", reeb::tools::add_extract},   {"pairs", reeb::tools::add_pairs},
    {"plot", reeb::tools::add_plot},         {"verify", reeb::tools::add_verify},
    {"generate", reeb::tools::add_generate}, {"convert", reeb::tools::add_convert},
    {"defects", reeb::tools::add_defects},   {"repair", reeb::tools::add_repair},
    {"function", reeb::tools::add_function}, {"segment", reeb::tools::add_segment},
    {"report", reeb::tools::add_report},     {"view", reeb::tools::add_view},
    {"fragment", reeb::tools::add_fragment}, {"glue", reeb::tools::add_glue},
};

bool is_command(const std::string& word) {
  return std::ranges::find(kCommands, word, &NamedCommand::name) != std::end(kCommands);
}

// For a word that is no command; `else_a_file`: nor a file, which it could be as well.
reeb::Error no_such_command(const std::string& word, bool else_a_file) {
  std::vector<std::string> names;
  for (const NamedCommand& command : kCommands) names.emplace_back(command.name);
  const std::string near = reeb::nearest(word, names);
  return {reeb::ErrorKind::kUsage,
          "there is no command '" + word + "'" + (else_a_file ? ", and no file of that name" : "") +
              (near.empty() ? "" : " (did you mean " + near + "?)"),
          fmt::format("the commands are {}", fmt::join(names, ", "))};
}

// `reeb scan.ply` means `reeb compute scan.ply`: a first word that is not a command is the name of a mesh.
// THROWS: Error{kUsage} if it is neither.
std::vector<std::string> with_default_command(std::vector<std::string> words) {
  const std::string& first = words[0];
  if (first == "-h" || first == "--help" || first == "--version") return words;
  if (first == "help") {
    if (words.size() == 1) return {"--help"};
    if (!is_command(words[1])) throw no_such_command(words[1], false);
    return {words[1], "--help"};
  }
  if (is_command(first)) return words;
  const bool is_name = first.starts_with('-') || first.find_first_of("./") != std::string::npos;
  if (std::error_code ignored; !is_name && !std::filesystem::exists(first, ignored)) throw no_such_command(first, true);
  words.insert(words.begin(), "compute");
  return words;
}

int run(int argc, char** argv) {
  reeb::tools::Program program("reeb", "Exact Reeb graphs of meshes of any size");
  program.set_version("reeb " REEB_VERSION);
  program.set_usage("reeb COMMAND [OPTIONS]\n       reeb MESH [OPTIONS]      the same as reeb compute MESH");
  program.footer(kExamples);
  const std::vector<std::string> words =
      argc == 1 ? std::vector<std::string>() : with_default_command(std::vector<std::string>(argv + 1, argv + argc));
  // The others' options would only take time.
  const bool knows_command = !words.empty() && is_command(words[0]);
  for (const NamedCommand& command : kCommands)
    if (!knows_command || command.name == words[0]) command.add(program);
  if (words.empty()) {
    fmt::print("{}", program.help());
    return 0;
  }
  if (const auto text = program.run(words)) fmt::print("{}", *text);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  reeb::tools::protect_standard_streams();
  reeb::tools::set_up_process_memory();
  reeb::ooc::own_process();
  reeb::tools::handle_signals();
  try {
    const int code = run(argc, argv);
    reeb::tools::finish_standard_output();
    return code;
  } catch (const reeb::Error& error) {
    if (error.file() == reeb::io::kStandardOutputShown) reeb::tools::end_if_nobody_reads();
    return report(error.kind(), error.what(), error.hint());
  } catch (const std::bad_alloc&) {
    return report(reeb::ErrorKind::kResource, "out of memory", "close other programs, or use a smaller mesh");
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) reeb::tools::end_if_nobody_reads();
    return report(error);
  } catch (const std::exception& error) {
    return report(error);
  }
}
