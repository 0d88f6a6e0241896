// Values as parts of a page. Names come from other people, so nothing of them may act as markup.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

namespace reeb::tools {

// For text and for attributes in double quotes. Control characters and bytes that are not UTF-8 as printable() has
// them.
std::string html_text(std::string_view text);

// For the inside of a <script>, whatever the strings in it are.
std::string script_json(const nlohmann::ordered_json& json);

// The place of the value between `min` and `min + 2 * half_size`, rounded; 0 where the size is. Sizes can be beyond the
// doubles, their halves cannot.
std::uint16_t in_65535ths(double value, double min, double half_size);

// Numbers as base64, low bytes first.
std::string base64(std::span<const std::uint16_t> numbers);

// Six digits are enough for people.
std::string short_number(double value);

}  // namespace reeb::tools
