#include "tools/program/quantity.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "io/text/words.h"
#include "libreeb/base/count_text.h"
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

// "%", also after blanks, as in "5 %".
bool is_percent(std::string_view text) { return text.ends_with('%') && text.find_first_not_of(' ') == text.size() - 1; }

// The exponent of the unit at the start of `text`, which becomes what follows it: 1 for k, 2 for M; 0 without one.
int take_unit(std::string_view& text) {
  constexpr std::string_view kUnits = "KMGT";
  if (text.empty()) return 0;
  const auto unit = kUnits.find(static_cast<char>(std::toupper(static_cast<unsigned char>(text.front()))));
  if (unit == std::string_view::npos) return 0;
  text.remove_prefix(1);
  return static_cast<int>(unit) + 1;
}

[[noreturn]] void refuse(const std::string& option, const std::string& text, const char* what,
                         const std::string& hint) {
  throw Error(ErrorKind::kUsage, option + ": \"" + text + "\" is not " + what, hint);
}

// Doubles are exact up to 2^53 only, so numbers of digits alone are read as they are.
std::optional<std::uint64_t> count_with_unit(std::string_view text) {
  if (const auto value = io::whole_number<std::uint64_t>(text)) return value;
  const double number = take_number(text);
  // The product is rounded: 4.1M is a whole number, and 4.1 is none of the doubles.
  const double unit = std::pow(1000.0, take_unit(text)), whole = std::nearbyint(number * unit);
  if (number < 0 || !text.empty() || whole / unit != number || whole >= 0x1p63) return {};
  return static_cast<std::uint64_t>(whole);
}

}  // namespace

std::uint64_t parse_size(const std::string& option, const std::string& text) {
  constexpr const char* kHint = "give a size like 512K, 64M or 1.5GiB";
  std::string_view rest = text;
  const double number = take_number(rest);
  if (number < 0) refuse(option, text, "a size", kHint);
  const int unit = take_unit(rest);
  if (unit != 0 && rest.starts_with('i') && rest.size() == 2) rest.remove_prefix(1);
  if (!rest.empty() && rest != "B" && rest != "b") refuse(option, text, "a size", kHint);
  const double bytes = std::ldexp(number, 10 * unit);
  if (bytes >= 0x1p63) refuse(option, text, "a size that a machine can have", kHint);
  return static_cast<std::uint64_t>(bytes);
}

std::uint64_t parse_count(const std::string& option, const std::string& text, CountLimits limits) {
  const auto count = count_with_unit(text);
  if (!count)
    refuse(option, text, "a whole number",
           "give a number from " + std::to_string(limits.least) + " on, like 50000, 50k, 1.5M or 1e6");
  if (*count < limits.least)
    throw Error(ErrorKind::kUsage, option + " must be at least " + with_commas(limits.least), "give a larger number");
  if (*count > limits.most)
    throw Error(ErrorKind::kUsage, option + " can be at most " + with_commas(limits.most), "give a smaller number");
  return *count;
}

double parse_threshold(const std::string& option, const std::string& text, const ValueRange& range) {
  std::string_view rest = text;
  const double value = take_number(rest);
  if (value < 0 || (!rest.empty() && !is_percent(rest)))
    refuse(option, text, "a threshold",
           "give a number from 0 on with a decimal point, like 0.01, or a share of the range, like 0.1%");
  return rest.empty() ? value : range.part(value / 100);
}

std::string large_threshold(const std::string& text, const ValueRange& range, const std::string& function) {
  const double threshold = parse_threshold("threshold", text, range), width = range.max - range.min;
  constexpr double kTypedBack = 1.001;  // the range itself, rounded
  if (!(width > 0) || threshold <= kTypedBack * width) return {};
  if (text.ends_with('%')) return fmt::format("the threshold {} is more than the range of {}", text, function);
  return fmt::format("the threshold {} is more than the range {:.6g} of {}{}", text, width, function,
                     threshold <= 100 ? "; did you mean " + text + "%?" : std::string());
}

double percent_of(const ValueRange& range, double lo, double hi) {
  const double width = range.max - range.min;
  return 100 * (std::isfinite(width) ? (hi - lo) / width : (hi / 2 - lo / 2) / (range.max / 2 - range.min / 2));
}

double parse_share(const std::string& option, const std::string& text, const std::string& hint) {
  std::string_view rest = text;
  const double percent = take_number(rest);
  if (!(percent >= 0 && percent <= 100) || !is_percent(rest)) refuse(option, text, "a share", hint);
  return percent;
}

double parse_length(const std::string& option, const std::string& text) {
  std::string_view rest = text;
  const double length = take_number(rest);
  if (!(length >= 0) || !rest.empty()) refuse(option, text, "a length", "give it in the units of the mesh");
  return length;
}

}  // namespace reeb::tools
