#include "io/streaming/block_head.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/events/stream_fault.h"
#include "io/mesh/scalar_bytes.h"

namespace reeb::io {
namespace {

constexpr std::int32_t kMaxCommentBytes = 1 << 20;
constexpr std::size_t kMaxHeadBytes = 64u << 20;
constexpr std::size_t kJudgedBlocks = 64;
// Both readings look at this many bytes in one view.
static_assert(256 + kJudgedBlocks * (4 + kBlockElements * 16) <= ContentSource::kLookahead);
constexpr std::uint64_t kImplausible = std::numeric_limits<std::uint64_t>::max();

// A head, read in one byte order. `fault` is the first thing found wrong.
struct HeadReading {
  bool swap = false;
  StreamHeader header;
  std::uint64_t end = 0;  // offset of what follows the head, or of the fault
  bool truncated = false;
  std::string fault;  // empty: plausible

  bool is_plausible() const { return fault.empty(); }
  bool refuse(std::string what) {
    fault = std::move(what);
    return false;
  }
  bool refuse_truncated() {
    truncated = true;
    return refuse("file ends inside the header");
  }
};

// Reads the number of comments; the cursor stays before it.
std::int32_t read_comment_count(Cursor& cursor, HeadReading& reading) {
  reading.end = cursor.offset();
  if (!cursor.ensure(4)) {
    reading.refuse_truncated();
    return 0;
  }
  const std::int32_t count = load_scalar<std::int32_t>(cursor.data(), reading.swap);
  reading.end += 4;
  if (count < 0 || static_cast<std::size_t>(count) > kMaxComments)
    reading.refuse("comment count " + std::to_string(count) + " is not plausible");
  return reading.is_plausible() ? count : 0;
}

bool read_comment(Cursor& cursor, HeadReading& reading) {
  if (!cursor.ensure(4)) return reading.refuse_truncated();
  const std::int32_t length = load_scalar<std::int32_t>(cursor.data(), reading.swap);
  cursor.advance(4);
  reading.end = cursor.offset();
  if (length < 0 || length > kMaxCommentBytes)
    return reading.refuse("comment length " + std::to_string(length) + " is not plausible");
  auto left = static_cast<std::size_t>(length);
  if (reading.end + left > kMaxHeadBytes) return reading.refuse("more than 64 MiB of comments");
  std::string& comment = reading.header.comments.emplace_back();
  while (left != 0) {
    if (cursor.at_end()) return reading.refuse_truncated();
    const std::size_t size = std::min(left, cursor.available());
    comment.append(cursor.data(), size);
    cursor.advance(size);
    left -= size;
  }
  reading.end = cursor.offset();
  return true;
}

// Reads the comments, and moves past them. No number but 0 is a plausible count in both byte orders, so at most one
// of the readings has comments.
void read_comments(Cursor& cursor, HeadReading& first, HeadReading& second) {
  const std::int32_t first_count = read_comment_count(cursor, first), second_count = read_comment_count(cursor, second);
  if (!first.is_plausible() && !second.is_plausible()) return;
  cursor.advance(4);
  HeadReading& reading = second_count != 0 ? second : first;
  for (std::int32_t left = std::max(first_count, second_count); left != 0; --left)
    if (!read_comment(cursor, reading)) return;
}

// Reads what follows the comments, without moving the cursor.
class HeadParser {
 public:
  HeadParser(Cursor& cursor, HeadReading& reading) : cursor_(cursor), reading_(reading) {}

  void parse() {
    if (read_counts()) (reading_.header.volume ? read_widths() : read_box());
    reading_.end = cursor_.offset() + at_;
  }

 private:
  bool refuse(std::string what) { return reading_.refuse(std::move(what)); }
  bool have(std::size_t count) { return cursor_.ensure(at_ + count) || reading_.refuse_truncated(); }
  bool read_integer(std::int32_t& value) {
    if (!have(4)) return false;
    value = load_scalar<std::int32_t>(cursor_.data() + at_, reading_.swap);
    at_ += 4;
    return true;
  }

  bool read_count(std::optional<std::uint32_t>& count, const char* what) {
    std::int32_t value = 0;
    if (!read_integer(value)) return false;
    if (value < -1) return refuse("number of " + std::string(what) + " " + std::to_string(value) + " is not plausible");
    if (value >= 0) count = static_cast<std::uint32_t>(value);
    return true;
  }
  bool read_counts() {
    return read_count(reading_.header.vertex_count, "vertices") && read_count(reading_.header.cell_count, "cells");
  }

  bool read_flag(bool& set) {
    if (!have(1)) return false;
    const unsigned value = static_cast<unsigned char>(cursor_.data()[at_++]);
    set = value == 1;
    return value <= 1 || refuse("bounding box flag " + std::to_string(value) + " is not plausible");
  }

  // Reads the minima and maxima of `width` values; if they are floats, the first three are the box.
  bool read_bounds(std::size_t width, bool floats) {
    bool present = false;
    if (!read_flag(present)) return false;
    if (!present) return true;
    if (!have(8 * width)) return false;
    const char* data = cursor_.data() + at_;
    at_ += 8 * width;
    if (!floats) return true;
    StreamBox box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = load_scalar<float>(data + 4 * k, reading_.swap);
      box.max[k] = load_scalar<float>(data + 4 * (width + k), reading_.swap);
      if (!std::isfinite(box.min[k]) || !std::isfinite(box.max[k]) || box.min[k] > box.max[k])
        return refuse("the bounding box is not plausible");
    }
    reading_.header.box = box;
    return true;
  }
  bool read_box() { return read_bounds(3, true); }

  bool read_widths() {
    std::int32_t floats = 0, ints = 0;
    if (!read_integer(floats) || !read_integer(ints)) return false;
    if (floats < 3 || floats > 4 || ints < 0 || ints > 4 - floats)
      return refuse(std::to_string(floats) + " floats and " + std::to_string(ints) +
                    " integers per vertex are not possible");
    reading_.header.vertex_floats = static_cast<unsigned>(floats);
    reading_.header.vertex_ints = static_cast<unsigned>(ints);
    return read_bounds(reading_.header.vertex_floats, true) &&
           (ints == 0 || read_bounds(reading_.header.vertex_ints, false));
  }

  Cursor& cursor_;
  HeadReading& reading_;
  std::size_t at_ = 0;
};

bool odd_coordinate(float value) {
  const float magnitude = std::abs(value);
  return !std::isfinite(value) || (value != 0 && (magnitude < 1e-30f || magnitude > 1e30f));
}

// Counts the elements in the first blocks that make no sense in the byte order of `reading`.
class Judge {
 public:
  // The cursor is after the comments.
  Judge(Cursor& cursor, const HeadReading& reading)
      : cursor_(cursor), reading_(reading), words_(reading.header.volume ? 4 : 3) {
    if (const auto size = cursor_.source().size(); size && *size >= reading.end)
      most_elements_ = (*size - reading.end) / (4 * words_);
  }

  std::uint64_t badness() {
    if (!reading_.is_plausible()) return kImplausible;
    std::uint64_t bad = 0;
    for (const auto& count : {reading_.header.vertex_count, reading_.header.cell_count})
      bad += count && most_elements_ && *count > *most_elements_;
    auto at = static_cast<std::size_t>(reading_.end - cursor_.offset());
    for (std::size_t block = 0; block < kJudgedBlocks && cursor_.ensure(at + 4); ++block) {
      const std::uint32_t descriptor = load_scalar<std::uint32_t>(cursor_.data() + at, reading_.swap);
      at += 4;
      if (block == 0) post_order_ = (descriptor & 1) == 0;
      for (std::size_t j = 0; j < kBlockElements && cursor_.ensure(at + 4 * words_); ++j) {
        const char* element = cursor_.data() + at;
        bad += ((descriptor >> j) & 1) != 0 ? odd_vertex(element) : odd_cell(element);
        at += 4 * words_;
      }
    }
    return bad;
  }

 private:
  bool odd_vertex(const char* element) {
    ++vertices_;
    bool odd = false;
    for (std::size_t k = 0; k < 3; ++k) odd = odd || odd_coordinate(load_scalar<float>(element + 4 * k, reading_.swap));
    return odd;
  }
  bool odd_cell(const char* element) const {
    const std::int64_t limit = !post_order_                   ? vertices_
                               : reading_.header.vertex_count ? std::int64_t{*reading_.header.vertex_count}
                               : most_elements_               ? static_cast<std::int64_t>(*most_elements_)
                                                              : std::int64_t{1} << 28;
    const std::int64_t least = post_order_ ? 0 : -vertices_;
    bool odd = false;
    for (std::size_t k = 0; k < words_; ++k) {
      const std::int64_t n = load_scalar<std::int32_t>(element + 4 * k, reading_.swap);
      odd = odd || n == 0 || n > limit || n < least;
    }
    return odd;
  }

  Cursor& cursor_;
  const HeadReading& reading_;
  std::size_t words_;
  std::optional<std::uint64_t> most_elements_;
  std::int64_t vertices_ = 0;
  bool post_order_ = false;
};

// The cursor is after the head.
bool judge_post_order(Cursor& cursor, const StreamHeader& header, bool swap) {
  const std::size_t element = header.volume ? 16 : 12;
  return cursor.ensure(4 + element) && (load_scalar<std::uint32_t>(cursor.data(), swap) & 1) == 0;
}

}  // namespace

BlockHead read_block_head(Cursor& cursor, bool volume) {
  if (!cursor.ensure(4)) fail(Fault::kTruncated, "file ends inside the header", "0");
  const auto byte = [&](std::size_t i) -> unsigned { return static_cast<unsigned char>(cursor.data()[i]); };
  if (byte(1) > 1) fail(Fault::kBadHeader, "byte order mark " + std::to_string(byte(1)) + " is neither 0 nor 1", "1");
  for (std::size_t i = 2; i < 4; ++i)
    if (byte(i) != 0)
      fail(Fault::kUnsupported, "compression " + std::to_string(byte(i)) + " is not known", std::to_string(i));

  HeadReading first, second;
  first.swap = byte(1) == 1;
  second.swap = !first.swap;
  for (HeadReading* reading : {&first, &second}) {
    reading->header.volume = volume;
    reading->header.format = volume ? "SVB" : "SMB";
  }
  cursor.advance(4);
  read_comments(cursor, first, second);
  for (HeadReading* reading : {&first, &second})
    if (reading->is_plausible()) HeadParser(cursor, *reading).parse();
  const std::uint64_t first_bad = Judge(cursor, first).badness();
  const std::uint64_t second_bad = Judge(cursor, second).badness();
  if (first_bad == kImplausible && second_bad == kImplausible)
    fail(first.truncated ? Fault::kTruncated : Fault::kBadHeader, first.fault, std::to_string(first.end));

  const bool overruled = first_bad > second_bad;
  HeadReading& chosen = overruled ? second : first;
  cursor.advance(static_cast<std::size_t>(chosen.end - cursor.offset()));
  chosen.header.post_order = judge_post_order(cursor, chosen.header, chosen.swap);
  chosen.header.format += chosen.swap ? " big endian" : " little endian";
  return {std::move(chosen.header), chosen.swap, overruled};
}

}  // namespace reeb::io
