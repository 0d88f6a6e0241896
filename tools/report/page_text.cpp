#include "tools/report/page_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/text/base64_encoder.h"

namespace reeb::tools {

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
  std::string out;
  io::Base64Encoder encoder([&](std::string_view digits) { out += digits; });
  for (const std::uint16_t number : numbers) {
    encoder.put(static_cast<std::uint8_t>(number & 0xff));
    encoder.put(static_cast<std::uint8_t>(number >> 8));
  }
  encoder.finish();
  return out;
}

}  // namespace reeb::tools
