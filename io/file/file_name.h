// What the name of a file says about its content.
#pragma once

#include <string>

namespace reeb::io {

// The suffix in lower case, with its dot: ".ply".
std::string name_suffix(const std::string& path);

// The name without .gz or .zst, if it ends so.
std::string content_name(const std::string& path);
// The suffix before .gz or .zst.
std::string content_suffix(const std::string& path);

// Whether a name has a suffix of streaming meshes (.sma .smb .smc .smd .sva .svb .svc), with or without .gz or .zst
// after it.
bool is_streaming_name(const std::string& path);

}  // namespace reeb::io
