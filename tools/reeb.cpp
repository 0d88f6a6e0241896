// The program `reeb`: finds the subcommand, and turns every error into one line, a hint and an exit
// code (INTERFACE.md, Errors).
#include <fmt/core.h>

#include <exception>
#include <new>
#include <string>

#include "libreeb/base/error.h"
#include "tools/commands/commands.h"

namespace {

int report(reeb::ErrorKind kind, const std::string& what, const std::string& hint) {
  fmt::print(stderr, "reeb: error: {}\nhint: {}\n", what, hint);
  return static_cast<int>(kind);
}

int run(int argc, char** argv) {
  CLI::App program("Exact Reeb graphs of meshes of any size", "reeb");
  program.require_subcommand(1);
  reeb::tools::add_generate(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error);  // --help
    return report(reeb::ErrorKind::kUsage, error.what(),
                  "see reeb --help, or --help of the command");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const reeb::Error& error) {
    return report(error.kind(), error.what(), error.hint());
  } catch (const std::bad_alloc&) {
    return report(reeb::ErrorKind::kResource, "out of memory",
                  "close other programs, or use a smaller mesh");
  } catch (const std::exception& error) {
    return report(reeb::ErrorKind::kResource, error.what(), "please report this as a defect");
  }
}
