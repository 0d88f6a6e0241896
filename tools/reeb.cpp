// The program `reeb`. Subcommands live in tools/commands, one file each.
#include <fmt/core.h>

int main() {
  fmt::print(stderr, "reeb: no command yet\n");
  return 2;
}
