// The "#" lines before the body of an SMA or SVA file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "io/events/stream_event.h"
#include "io/text/entry_limit.h"

namespace reeb::io {

// Whether the first word of a "#" line means more than a comment: in the head of either kind, or of SVA only.
bool is_head_keyword(std::string_view word);
bool is_volume_keyword(std::string_view word);

// Collects the head line by line. A file is a volume mesh (SVA) as soon as a keyword says so.
class TextHead {
 public:
  explicit TextHead(StreamHeader& header) : header_(header) {}

  // `line` starts with '#'. THROWS: BAD_HEADER, UNSUPPORTED (another type of cells).
  void read_line(std::string_view line, std::uint64_t number);
  // After the last line. THROWS: BAD_HEADER.
  void finish();

 private:
  bool read_keyword(std::string_view line, std::string_view word, std::size_t after);
  void read_count(std::size_t after, std::optional<std::uint32_t>& count);
  void read_width(std::size_t after, unsigned& width, std::int32_t least);
  void read_corner(std::size_t after, std::array<float, 3>& corner, bool& seen);
  [[noreturn]] void fail_here(const std::string& what, std::size_t column) const;

  StreamHeader& header_;
  std::string_view line_;
  std::uint64_t number_ = 0;
  StreamBox box_{};
  bool has_min_ = false, has_max_ = false;
  struct Line {
    std::string text;
    std::uint64_t number;
    std::size_t comment;  // its place among the comments
  };
  std::optional<Line> cells_line_;                 // "ncells" before it is known whether that is a keyword
  EntryLimit comment_limit_{"comments", 160'000};  // 16 MB of text
};

}  // namespace reeb::io
