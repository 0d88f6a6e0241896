// Numbers as the text formats print them (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include <string>

namespace reeb::io {

// `%.17g` in the C locale, -0 as 0: restores every double exactly.
void append_double(std::string& out, double value);

}  // namespace reeb::io
