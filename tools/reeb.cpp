// The program `reeb`: finds the subcommand, and turns every error into one line, a hint and an exit code (docs/CLI.md).
#include <fmt/core.h>
#include <malloc.h>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "libreeb/base/error.h"
#include "tools/commands/commands.h"
#include "tools/program/signals.h"

namespace {

int report(reeb::ErrorKind kind, const std::string& what, const std::string& hint) {
  fmt::print(stderr, "reeb: error: {}\nhint: {}\n", what, hint);
  return static_cast<int>(kind);
}

constexpr const char* kExamples = R"(Examples:
  reeb scan.ply                          the Reeb graph of the height, as scan.reeb
  reeb scan.ply -f x --memory 64M        another function, in 64 MB
  reeb extract scan.reeb --nodes 100 -o coarse.dot
                                         the finest level with at most 100 nodes

Every command has --help.)";

// `reeb scan.ply` means `reeb compute scan.ply`: a first word that is not a command is the name of a mesh.
std::vector<std::string> with_default_command(const CLI::App& program, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool is_command =
      !words.empty() &&
      !program.get_subcommands([&](const CLI::App* command) { return command->get_name() == words[0]; }).empty();
  const bool is_help = words.empty() || words[0] == "-h" || words[0] == "--help" || words[0] == "--version";
  if (!is_command && !is_help) words.insert(words.begin(), "compute");
  std::reverse(words.begin(), words.end());  // CLI11 takes them in reverse order
  return words;
}

int run(int argc, char** argv) {
  CLI::App program("Exact Reeb graphs of meshes of any size", "reeb");
  program.require_subcommand(0, 1);
  program.set_version_flag("--version", "reeb " REEB_VERSION);
  program.footer(kExamples);
  reeb::tools::add_compute(program);
  reeb::tools::add_info(program);
  reeb::tools::add_extract(program);
  reeb::tools::add_pairs(program);
  reeb::tools::add_verify(program);
  reeb::tools::add_generate(program);
  reeb::tools::add_convert(program);
  if (argc == 1) {
    fmt::print("{}", program.help());
    return 0;
  }
  try {
    program.parse(with_default_command(program, argc, argv));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help
    return report(reeb::ErrorKind::kUsage, error.what(), "see reeb --help, or the command's own --help");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  // Large blocks return to the system as soon as they are freed. So resident memory is what the budget counts, not what
  // was needed at some earlier time.
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);
  mallopt(M_TRIM_THRESHOLD, 256 * 1024);
  mallopt(M_ARENA_MAX, 2);
  reeb::tools::turn_signals_into_errors();
  try {
    return run(argc, argv);
  } catch (const reeb::Error& error) {
    return report(error.kind(), error.what(), error.hint());
  } catch (const std::bad_alloc&) {
    return report(reeb::ErrorKind::kResource, "out of memory", "close other programs, or use a smaller mesh");
  } catch (const std::system_error& error) {  // from fmt, which writes to standard output only
    return report(reeb::ErrorKind::kResource, std::string("standard output ") + error.what(),
                  "keep the reading program open, or free disk space");
  } catch (const std::exception& error) {
    return report(reeb::ErrorKind::kResource, error.what(), "please report this as a bug");
  }
}
