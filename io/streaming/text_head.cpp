#include "io/streaming/text_head.h"

#include <algorithm>

#include "io/events/stream_fault.h"
#include "io/streaming/text_lines.h"
#include "io/text/words.h"

namespace reeb::io {
namespace {

constexpr std::string_view kKeywords[] = {"nverts", "nfaces", "ncells", "bb_min", "bb_max"};
constexpr std::string_view kVolumeKeywords[] = {"svtype",   "v_pnum_f", "v_pnum_i", "v_pmin_f", "v_pmin_i",
                                                "v_pmax_f", "v_pmax_i", "c_pnum_f", "c_pnum_i", "c_pmin_f",
                                                "c_pmin_i", "c_pmax_f", "c_pmax_i"};

}  // namespace

bool is_volume_keyword(std::string_view word) {
  return std::ranges::find(kVolumeKeywords, word) != std::ranges::end(kVolumeKeywords);
}
bool is_head_keyword(std::string_view word) {
  return std::ranges::find(kKeywords, word) != std::ranges::end(kKeywords) || is_volume_keyword(word);
}

void TextHead::fail_here(const std::string& what, std::size_t column) const {
  fail(Fault::kBadHeader, what, std::to_string(number_) + ":" + std::to_string(column));
}

void TextHead::read_line(std::string_view line, std::uint64_t number) {
  line_ = line;
  number_ = number;
  LineCursor cursor(line, 1);
  const std::string_view word = cursor.word();
  if (read_keyword(line, word, cursor.column() - 1 + word.size())) return;
  if (word == "ncells") cells_line_ = {std::string(line), number, header_.comments.size()};
  const std::string_view comment = trimmed(line.substr(1));
  struct Place {
    const TextHead& head;
    void fail(const std::string& what, const std::string&) const { head.fail_here(what, 1); }
  };
  comment_limit_.add(1, comment.size(), Place{*this});
  header_.comments.emplace_back(comment);
}

bool TextHead::read_keyword(std::string_view line, std::string_view word, std::size_t after) {
  const bool volume_word = is_volume_keyword(word);
  if (volume_word && !header_.volume) {
    header_.volume = true;
    header_.cell_count.reset();  // it was that of faces
  }
  if (word == "nverts")
    read_count(after, header_.vertex_count);
  else if (word == (header_.volume ? "ncells" : "nfaces"))
    read_count(after, header_.cell_count);
  else if (word == "v_pnum_f")
    read_width(after, header_.vertex_floats, 3);
  else if (word == "v_pnum_i")
    read_width(after, header_.vertex_ints, 0);
  else if (word == "c_pnum_f")
    read_width(after, header_.cell_floats, 0);
  else if (word == "c_pnum_i")
    read_width(after, header_.cell_ints, 0);
  else if (word == "bb_min" || word == "v_pmin_f")
    read_corner(after, box_.min, has_min_);
  else if (word == "bb_max" || word == "v_pmax_f")
    read_corner(after, box_.max, has_max_);
  else if (word == "svtype") {
    LineCursor cursor(line, after);
    if (const auto type = cursor.word(); type != "tet")
      fail(Fault::kUnsupported, "cells of type '" + std::string(type) + "'; only tetrahedra are read",
           std::to_string(number_) + ":" + std::to_string(cursor.column()));
  } else {
    return volume_word;  // bounds of further values are not used
  }
  return true;
}

void TextHead::read_count(std::size_t after, std::optional<std::uint32_t>& count) {
  LineCursor cursor(line_, after);
  std::int32_t value = 0;
  if (cursor.number(value) != NumberVerdict::kValid)
    fail_here("the count is not a number: '" + std::string(cursor.last_word()) + "'", cursor.column());
  count = value < 0 ? std::nullopt : std::optional(static_cast<std::uint32_t>(value));
}

void TextHead::read_width(std::size_t after, unsigned& width, std::int32_t least) {
  LineCursor cursor(line_, after);
  std::int32_t value = 0;
  const bool good = cursor.number(value) == NumberVerdict::kValid;
  const auto most = static_cast<std::int32_t>(kMaxFloats);
  if (!good || value < least || value > most)
    fail_here(std::string(cursor.last_word()) + " values each; " + std::to_string(least) + " to " +
                  std::to_string(most) + " are possible",
              cursor.column());
  width = static_cast<unsigned>(value);
}

void TextHead::read_corner(std::size_t after, std::array<float, 3>& corner, bool& seen) {
  LineCursor cursor(line_, after);
  for (float& value : corner)
    if (cursor.number(value) != NumberVerdict::kValid)
      fail_here("not a number in the bounding box: '" + std::string(cursor.last_word()) + "'", cursor.column());
  seen = true;
}

// A keyword that makes it a volume mesh can follow "ncells".
void TextHead::finish() {
  if (header_.volume && cells_line_) {
    header_.comments.erase(header_.comments.begin() + static_cast<std::ptrdiff_t>(cells_line_->comment));
    line_ = cells_line_->text;
    number_ = cells_line_->number;
    LineCursor cursor(line_, 1);
    const std::string_view word = cursor.word();
    read_count(cursor.column() - 1 + word.size(), header_.cell_count);
  }
  if (has_min_ && has_max_) header_.box = box_;
  header_.format = header_.volume ? "SVA" : "SMA";
}

}  // namespace reeb::io
