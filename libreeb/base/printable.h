// Text of other people, made safe to show: names of files, and what they contain.
#pragma once

#include <string>
#include <string_view>

namespace reeb {

// The same text with every control character, NUL and line end as "\x0a", and with every byte that is not part of a
// UTF-8 character as "\xff". So a name cannot end a message early, begin another line, or control a terminal. Other
// text is returned as it is.
std::string printable(std::string_view text);

}  // namespace reeb
