// Text for XML files.
#pragma once

#include <string>
#include <string_view>

#include "libreeb/base/printable.h"

namespace reeb::io {

// `text` as XML text or as the value of an attribute. XML has no way to write most control characters, so the text is
// made safe to show first (libreeb/base/printable.h).
inline std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : printable(text)) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace reeb::io
