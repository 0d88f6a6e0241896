// The page that shows a .reeb file: made of tools/viewer when the program is built.
#pragma once

#include <string_view>

namespace reeb::tools {

// Empty in a program that was built without pages (REEB_WEB=OFF).
std::string_view viewer_page();

}  // namespace reeb::tools
