// The text of HTTP/1.1, as far as a server of one page and one file needs it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace reeb::tools {

struct HttpRequest {
  std::string method;
  std::string path;   // decoded, without the query
  std::string host;   // empty if there is none, or several
  std::string range;  // empty if there is none
};

// `text`: from the request line to the empty line after the headers. Nothing if this is no request.
std::optional<HttpRequest> parse_request(std::string_view text);

// Part of a file of `size` bytes: its first byte, and the byte after its last.
struct ByteRange {
  std::uint64_t begin = 0, end = 0;
  bool operator==(const ByteRange&) const = default;
};

enum class RangeKind { kWhole, kPart, kNone };
struct AskedRange {
  RangeKind kind = RangeKind::kWhole;
  ByteRange range;
};

// What a Range header asks for: a part, the whole file (no header, or one that is not understood, as several ranges),
// or a part that the file does not have.
AskedRange asked_range(std::string_view header, std::uint64_t size);

// A name as one part of a path.
std::string path_part(std::string_view name);

}  // namespace reeb::tools
