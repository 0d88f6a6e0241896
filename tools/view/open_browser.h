// Shows an address to the user.
#pragma once

#include <string>

namespace reeb::tools {

// Asks the desktop to open the address, if there is one, and does not wait. Nothing happens if that fails.
void open_browser(const std::string& address);

}  // namespace reeb::tools
