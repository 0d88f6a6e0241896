// What the name of a file says about its content.
#pragma once

#include <string>
#include <string_view>

namespace reeb::io {

// The suffix in lower case, with its dot: ".ply".
std::string name_suffix(const std::string& path);

// The same before .gz or .zst, if the name ends so.
std::string content_suffix(const std::string& path);

// Whether a name has a suffix of streaming meshes (.sma .smb .smc .smd .sva .svb .svc), with or without .gz or .zst
// after it.
bool is_streaming_name(std::string_view path);

}  // namespace reeb::io
