#include "tools/program/quantity.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

// The number at the start of `text`, which becomes what follows it; negative if there is none.
double take_number(std::string_view& text) {
  double value = -1;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::general);
  if (result.ec != std::errc() || !std::isfinite(value)) return -1;
  text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
  return value;
}

[[noreturn]] void refuse(const std::string& text, const char* what, const char* hint) {
  throw Error(ErrorKind::kUsage, "'" + text + "' is not " + what, hint);
}

}  // namespace

std::uint64_t parse_size(const std::string& text) {
  constexpr std::string_view kUnits = "KMGT";
  constexpr const char* kHint = "give a size like 512K, 64M or 1.5GiB";
  std::string_view rest = text;
  double bytes = take_number(rest);
  if (bytes < 0) refuse(text, "a size", kHint);
  if (!rest.empty()) {
    const auto unit = kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(rest.front()))));
    if (unit != std::string_view::npos) {
      bytes = std::ldexp(bytes, 10 * (static_cast<int>(unit) + 1));
      rest.remove_prefix(1);
      if (rest.starts_with('i') && rest.size() == 2) rest.remove_prefix(1);
    }
    if (!rest.empty() && rest != "B" && rest != "b") refuse(text, "a size", kHint);
  }
  if (bytes >= 0x1p63) refuse(text, "a size that a machine can have", kHint);
  return static_cast<std::uint64_t>(bytes);
}

double parse_threshold(const std::string& text, double range) {
  std::string_view rest = text;
  const double value = take_number(rest);
  if (value < 0 || (!rest.empty() && rest != "%"))
    refuse(text, "a threshold", "give a number from 0 on, like 0.01, or a share of the range, like 0.1%");
  return rest.empty() ? value : value / 100 * range;
}

}  // namespace reeb::tools
