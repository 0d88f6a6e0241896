// The program `reeb`: finds the subcommand, and turns every error into one line, a hint and an exit code (docs/CLI.md).
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "io/file/file.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "ooc/run/explained_error.h"
#include "ooc/run/freed_memory.h"
#include "tools/arguments/arguments.h"
#include "tools/arguments/nearest_name.h"
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

// For a first word that is neither a command nor a file.
reeb::Error no_such_command(const reeb::tools::Program& program, const std::string& word) {
  const std::vector<std::string> names = program.command_names();
  const std::string near = reeb::tools::nearest(word, names);
  return {reeb::ErrorKind::kUsage,
          "there is no command '" + word + "', and no file of that name" +
              (near.empty() ? "" : " (did you mean " + near + "?)"),
          fmt::format("the commands are {}", fmt::join(names, ", "))};
}

// `reeb scan.ply` means `reeb compute scan.ply`: a first word that is not a command is the name of a mesh.
// THROWS: Error{kUsage} if it is neither.
std::vector<std::string> with_default_command(const reeb::tools::Program& program, std::vector<std::string> words) {
  const std::string& first = words[0];
  if (first == "-h" || first == "--help" || first == "--version") return words;
  if (first == "help") {
    if (words.size() == 1) return {"--help"};
    if (!program.has_command(words[1])) throw no_such_command(program, words[1]);
    return {words[1], "--help"};
  }
  if (program.has_command(first)) return words;
  const bool is_name = first.starts_with('-') || first.find_first_of("./") != std::string::npos;
  if (std::error_code ignored; !is_name && !std::filesystem::exists(first, ignored))
    throw no_such_command(program, first);
  words.insert(words.begin(), "compute");
  return words;
}

int run(int argc, char** argv) {
  reeb::tools::Program program("reeb", "Exact Reeb graphs of meshes of any size");
  program.set_version("reeb " REEB_VERSION);
  program.footer(kExamples);
  reeb::tools::add_compute(program);
  reeb::tools::add_info(program);
  reeb::tools::add_extract(program);
  reeb::tools::add_pairs(program);
  reeb::tools::add_plot(program);
  reeb::tools::add_verify(program);
  reeb::tools::add_generate(program);
  reeb::tools::add_convert(program);
  reeb::tools::add_defects(program);
  reeb::tools::add_repair(program);
  reeb::tools::add_function(program);
  reeb::tools::add_segment(program);
  reeb::tools::add_report(program);
  reeb::tools::add_view(program);
  reeb::tools::add_fragment(program);
  reeb::tools::add_glue(program);
  if (argc == 1) {
    fmt::print("{}", program.help());
    return 0;
  }
  const std::vector<std::string> words = with_default_command(program, std::vector<std::string>(argv + 1, argv + argc));
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
