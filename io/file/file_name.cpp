#include "io/file/file_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string_view>

namespace reeb::io {

std::string name_suffix(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

std::string content_name(const std::string& path) {
  const std::string suffix = name_suffix(path);
  return suffix == ".gz" || suffix == ".zst" ? path.substr(0, path.size() - suffix.size()) : path;
}

std::string content_suffix(const std::string& path) { return name_suffix(content_name(path)); }

bool is_streaming_name(const std::string& path) {
  constexpr std::array<std::string_view, 7> kSuffixes = {".sma", ".smb", ".smc", ".smd", ".sva", ".svb", ".svc"};
  return std::ranges::find(kSuffixes, content_suffix(path)) != kSuffixes.end();
}

}  // namespace reeb::io
