#include "io/file/file_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace reeb::io {

std::string name_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

std::string content_suffix(const std::string& path) {
  const std::string suffix = name_suffix(path);
  if (suffix != ".gz" && suffix != ".zst") return suffix;
  return name_suffix(path.substr(0, path.size() - suffix.size()));
}

bool is_streaming_name(std::string_view path) {
  for (const std::string_view ending : {".gz", ".zst"})
    if (path.ends_with(ending)) path.remove_suffix(ending.size());
  return std::ranges::any_of(std::array<std::string_view, 7>{".sma", ".smb", ".smc", ".smd", ".sva", ".svb", ".svc"},
                             [path](std::string_view ending) { return path.ends_with(ending); });
}

}  // namespace reeb::io
