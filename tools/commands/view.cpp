// `reeb view`: a .reeb file in a web page, served to this computer only.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "ooc/reeb_file/reeb_file.h"
#include "tools/arguments/options.h"
#include "tools/commands/commands.h"
#include "tools/library/run_files.h"
#include "tools/program/input_kind.h"
#include "tools/program/signals.h"
#include "tools/program/standard_streams.h"
#include "tools/program/whole_levels.h"
#include "tools/report/report.h"
#include "tools/view/file_server.h"
#include "tools/view/open_browser.h"
#include "tools/view/viewer_page.h"

namespace reeb::tools {
namespace {

struct ViewOptions {
  std::string file;
  std::uint16_t port = 0;
};

void view(const ViewOptions& options) {
  require_pages();
  require_reeb_file(options.file, "view");
  RunFiles files;
  files.add_input(options.file, "the .reeb file");
  files.add_standard_output("the address");
  files.check();
  warn_of_damage(ooc::ReebFile(options.file));
  FileServer server(viewer_page(), options.file, options.port);
  fmt::print("{}\n", server.address());
  finish_standard_output();  // nobody finds a server without its address
  fmt::print(stderr, "Only programs of this computer can open this address. Ctrl-C ends the server.\n");
  const auto stop = watch_signals();
  stop();
  open_browser(server.address());
  server.serve(stop);
}

}  // namespace

void add_view(Program& program) {
  auto options = std::make_shared<ViewOptions>();
  Command command = program.add_command("view", "Show a .reeb file in a browser, coarse levels first");
  command.add_option("FILE", options->file, "The .reeb file").required().type_name("");
  add_count(command, "--port", options->port, "Port on 127.0.0.1 (default: a free one)", {.least = 1, .most = 65535});
  command.footer("Example:\n  reeb view scan.reeb");
  command.callback([options] { view(*options); });
}

}  // namespace reeb::tools
