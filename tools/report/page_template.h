// The page into which a report is filled, with its style and its script: made of tools/web when the program is built.
#pragma once

#include <string_view>

namespace reeb::tools {

// Has places `<!--reeb:NAME-->`. Empty in a program that was built without pages (REEB_WEB=OFF).
std::string_view report_template();

}  // namespace reeb::tools
