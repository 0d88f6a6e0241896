// The program `reeb`. Subcommands live in tools/commands, one file each.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <new>

#include "libreeb/base/error.h"
#include "tools/commands/commands.h"

namespace {

int report(const reeb::Error& error) {
  fmt::print(stderr, "reeb: error: {}\nhint: {}\n", error.what(), error.hint());
  return static_cast<int>(error.kind());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Exact Reeb graphs of meshes of any size", "reeb");
  app.require_subcommand(1);
  reeb::tools::add_extract(app);
  reeb::tools::add_info(app);
  reeb::tools::add_pairs(app);
  reeb::tools::add_verify(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return report({reeb::ErrorKind::kUsage, error.what(), "see reeb --help"});
  } catch (const reeb::Error& error) {
    return report(error);
  } catch (const std::bad_alloc&) {
    return report({reeb::ErrorKind::kResource, "memory ran out", "ask for a coarser level, or use a larger machine"});
  }
}
