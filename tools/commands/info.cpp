// `reeb info`: what a file holds.
#include <memory>
#include <string>

#include "tools/commands/commands.h"
#include "tools/commands/reeb_info.h"

namespace reeb::tools {

void add_info(CLI::App& app) {
  struct Options {
    std::string file;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("info", "Say what a file holds");
  command->add_option("FILE", options->file, "a .reeb file")->required();
  command->add_flag("--json", options->json, "for programs");
  command->footer("Example:\n  reeb info scan.reeb");
  command->callback([options] { print_reeb_info(options->file, options->json); });
}

}  // namespace reeb::tools
