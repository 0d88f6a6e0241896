// Text for XML and HTML files.
#pragma once

#include <string>
#include <string_view>

#include "libreeb/base/printable.h"

namespace reeb::io {

// `text` as text or as the value of an attribute. XML has no way to write most control characters, so the text is
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
    else if (c == '\'')
      escaped += "&#39;";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace reeb::io
