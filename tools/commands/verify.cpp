// `reeb verify`: whether a .reeb file is whole and says nothing that contradicts itself.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "ooc/reeb_file.h"
#include "tools/commands/commands.h"

namespace reeb::tools {

void add_verify(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("verify", "Check a .reeb file: checksums, structure, counts");
  command->add_option("FILE", *path, "the .reeb file")->required();
  command->footer("Example:\n  reeb verify scan.reeb");
  command->callback([path] {
    const ooc::ReebFile file(*path);
    file.verify();
    const FileHeader& header = file.header();
    fmt::print("{}: good: {} nodes, {} arcs, {} components, {} loops, {} pairs, {} versions\n", *path, header.nodes,
               header.arcs, header.components, header.loops, header.pairs, std::uint64_t{header.steps} + 1);
  });
}

}  // namespace reeb::tools
