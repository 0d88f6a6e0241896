#include "tools/view/http_text.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "io/text/words.h"

namespace reeb::tools {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

bool is_name(std::string_view text, std::string_view lower_case) {
  return std::ranges::equal(text, lower_case,
                            [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

// A number without sign that has nothing after it. One beyond 64 bits is as good as the largest.
std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error == std::errc::invalid_argument || end != text.data() + text.size()) return {};
  return error == std::errc::result_out_of_range ? std::numeric_limits<std::uint64_t>::max() : value;
}

}  // namespace

std::optional<HttpRequest> parse_request(std::string_view text) {
  const std::string_view line = text.substr(0, text.find(kLineEnd));
  const std::size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == 0 || first == last) return {};
  const std::string_view version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") return {};
  const std::string_view target = line.substr(first + 1, last - first - 1);
  HttpRequest request;
  request.method = line.substr(0, first);
  io::PercentDecoded path = io::percent_decoded(target.substr(0, target.find('?')));
  if (!path.is_valid) return {};
  request.path = std::move(path.text);
  std::size_t hosts = 0;
  std::string_view rest = text.substr(line.size());
  while (rest.starts_with(kLineEnd)) {
    rest.remove_prefix(kLineEnd.size());
    const std::string_view header = rest.substr(0, rest.find(kLineEnd));
    rest.remove_prefix(header.size());
    const std::size_t colon = header.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string_view name = header.substr(0, colon), value = io::trimmed(header.substr(colon + 1));
    if (is_name(name, "range")) request.range = value;
    if (is_name(name, "host")) {
      request.host = value;
      ++hosts;
    }
  }
  if (hosts != 1) request.host.clear();
  return request;
}

AskedRange asked_range(std::string_view header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit)) return {RangeKind::kWhole, {0, size}};
  header.remove_prefix(kUnit.size());
  const std::size_t dash = header.find('-');
  if (dash == std::string_view::npos) return {RangeKind::kWhole, {0, size}};
  const std::string_view before = io::trimmed(header.substr(0, dash)), after = io::trimmed(header.substr(dash + 1));
  const auto first = number(before), last = number(after);
  if ((!before.empty() && !first) || (!after.empty() && !last) || (!first && !last) ||
      (first && last && *last < *first))
    return {RangeKind::kWhole, {0, size}};
  if (!first)  // the last bytes
    return *last == 0 || size == 0 ? AskedRange{RangeKind::kNone, {}}
                                   : AskedRange{RangeKind::kPart, {size - std::min(*last, size), size}};
  if (*first >= size) return {RangeKind::kNone, {}};
  return {RangeKind::kPart, {*first, last && *last < size ? *last + 1 : size}};
}

std::string path_part(std::string_view name) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (kPlain.find(c) != std::string_view::npos)
      out += c;
    else
      (out += '%', out += kDigits[byte / 16], out += kDigits[byte % 16]);
  }
  return out;
}

}  // namespace reeb::tools
