// Values as parts of a page. io/text/xml_text.h has its texts.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace reeb::tools {

// For the inside of a <script>. Strings in it come from other people, and none of them may act as markup.
std::string script_json(const nlohmann::ordered_json& json);

// The place of the value between `min` and `min + 2 * half_size`, rounded; 0 where the size is. Sizes can be beyond the
// doubles, their halves cannot.
std::uint16_t in_65535ths(double value, double min, double half_size);

// Numbers as base64, low bytes first.
std::string base64(std::span<const std::uint16_t> numbers);

}  // namespace reeb::tools
