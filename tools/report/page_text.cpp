#include "tools/report/page_text.h"

#include <fmt/core.h>
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "libreeb/base/printable.h"

namespace reeb::tools {

std::string html_text(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string script_json(const nlohmann::ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  // Outside of strings JSON has no such character.
  for (const char c : text)
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  return out;
}

std::uint16_t in_65535ths(double value, double min, double half_size) {
  if (!(half_size > 0)) return 0;
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp((value / 2 - min / 2) / half_size, 0.0, 1.0)));
}

std::string base64(std::span<const std::uint16_t> numbers) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t size = 2 * numbers.size();
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return i < size ? (std::uint32_t{numbers[i / 2]} >> (8 * (i % 2))) & 0xffu : 0u;
  };
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= size ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string short_number(double value) { return fmt::format("{:.6g}", value); }

}  // namespace reeb::tools
