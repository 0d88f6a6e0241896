// Numbers as the text formats print them (docs/CLI.md, `reeb extract FILE`).
#pragma once

#include <string>

namespace reeb::io {

// `%.17g` in the C locale, -0 as 0: restores every double exactly.
void append_double(std::string& out, double value);
// As few digits as restore the double, -0 as 0.
void append_shortest(std::string& out, double value);
// This many significant digits at most, -0 as 0.
void append_rounded(std::string& out, double value, int digits);

}  // namespace reeb::io
