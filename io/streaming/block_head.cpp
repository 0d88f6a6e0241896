#include "io/streaming/block_head.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/events/stream_fault.h"

namespace reeb::io {
namespace {

constexpr std::int32_t kMaxComments = 65535, kMaxCommentBytes = 1 << 20;
constexpr std::size_t kMaxHeadBytes = 64u << 20;
constexpr std::size_t kJudgedBlocks = 64;
constexpr std::uint64_t kImplausible = std::numeric_limits<std::uint64_t>::max();

// A head, read in one byte order. `fault` is the first thing found wrong.
struct HeadReading {
  WordOrder order;
  StreamHeader header;
  std::size_t bytes = 0;  // length of the head
  bool truncated = false;
  std::string fault;  // empty: plausible
};

class HeadParser {
 public:
  HeadParser(ByteWindow& window, WordOrder order, bool volume) : window_(window) {
    reading_.order = order;
    reading_.header.volume = volume;
    reading_.header.format = volume ? "SVB" : "SMB";
  }

  HeadReading parse() {
    if (read_comments() && read_counts()) (reading_.header.volume ? read_widths() : read_box());
    reading_.bytes = at_;
    return std::move(reading_);
  }

 private:
  bool refuse(std::string what) {
    reading_.fault = std::move(what);
    return false;
  }
  bool have(std::size_t count) {
    if (window_.ensure(at_ + count)) return true;
    reading_.truncated = true;
    return refuse("file ends inside the header");
  }
  bool read_integer(std::int32_t& value) {
    if (!have(4)) return false;
    value = reading_.order.integer(window_.data() + at_);
    at_ += 4;
    return true;
  }

  bool read_comments() {
    std::int32_t count = 0, length = 0;
    if (!read_integer(count)) return false;
    if (count < 0 || count > kMaxComments)
      return refuse("comment count " + std::to_string(count) + " is not plausible");
    for (std::int32_t i = 0; i < count; ++i) {
      if (!read_integer(length)) return false;
      if (length < 0 || length > kMaxCommentBytes)
        return refuse("comment length " + std::to_string(length) + " is not plausible");
      const auto size = static_cast<std::size_t>(length);
      if (at_ + size > kMaxHeadBytes) return refuse("more than 64 MiB of comments");
      if (!have(size)) return false;
      reading_.header.comments.emplace_back(reinterpret_cast<const char*>(window_.data() + at_), size);
      at_ += size;
    }
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
    const auto value = std::to_integer<unsigned>(window_.data()[at_++]);
    set = value == 1;
    return value <= 1 || refuse("bounding box flag " + std::to_string(value) + " is not plausible");
  }

  // Reads the minima and maxima of `width` values; if they are floats, the first three are the box.
  bool read_bounds(std::size_t width, bool floats) {
    bool present = false;
    if (!read_flag(present)) return false;
    if (!present) return true;
    if (!have(8 * width)) return false;
    const std::byte* data = window_.data() + at_;
    at_ += 8 * width;
    if (!floats) return true;
    StreamBox box{};
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = reading_.order.real(data + 4 * k);
      box.max[k] = reading_.order.real(data + 4 * (width + k));
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

  ByteWindow& window_;
  HeadReading reading_;
  std::size_t at_ = 4;
};

bool odd_coordinate(float value) {
  const float magnitude = std::abs(value);
  return !std::isfinite(value) || (value != 0 && (magnitude < 1e-30f || magnitude > 1e30f));
}

// Counts the elements in the first blocks that make no sense in the byte order of `reading`.
class Judge {
 public:
  Judge(ByteWindow& window, const HeadReading& reading)
      : window_(window), reading_(reading), words_(reading.header.volume ? 4 : 3) {
    if (const auto size = window.source_size(); size && *size >= window.position() + reading.bytes)
      most_elements_ = (*size - window.position() - reading.bytes) / (4 * words_);
  }

  std::uint64_t badness() {
    if (!reading_.fault.empty()) return kImplausible;
    std::uint64_t bad = 0;
    for (const auto& count : {reading_.header.vertex_count, reading_.header.cell_count})
      bad += count && most_elements_ && *count > *most_elements_;
    std::size_t at = reading_.bytes;
    for (std::size_t block = 0; block < kJudgedBlocks && window_.ensure(at + 4); ++block) {
      const std::uint32_t descriptor = reading_.order.word(window_.data() + at);
      at += 4;
      if (block == 0) post_order_ = (descriptor & 1) == 0;
      for (std::size_t j = 0; j < kBlockElements && window_.ensure(at + 4 * words_); ++j) {
        const std::byte* element = window_.data() + at;
        bad += ((descriptor >> j) & 1) != 0 ? odd_vertex(element) : odd_cell(element);
        at += 4 * words_;
      }
    }
    return bad;
  }

 private:
  bool odd_vertex(const std::byte* element) {
    ++vertices_;
    bool odd = false;
    for (std::size_t k = 0; k < 3; ++k) odd = odd || odd_coordinate(reading_.order.real(element + 4 * k));
    return odd;
  }
  bool odd_cell(const std::byte* element) const {
    const std::int64_t limit = !post_order_                   ? vertices_
                               : reading_.header.vertex_count ? std::int64_t{*reading_.header.vertex_count}
                               : most_elements_               ? static_cast<std::int64_t>(*most_elements_)
                                                              : std::int64_t{1} << 28;
    const std::int64_t least = post_order_ ? 0 : -vertices_;
    bool odd = false;
    for (std::size_t k = 0; k < words_; ++k) {
      const std::int64_t n = reading_.order.integer(element + 4 * k);
      odd = odd || n == 0 || n > limit || n < least;
    }
    return odd;
  }

  ByteWindow& window_;
  const HeadReading& reading_;
  std::size_t words_;
  std::optional<std::uint64_t> most_elements_;
  std::int64_t vertices_ = 0;
  bool post_order_ = false;
};

bool judge_post_order(ByteWindow& window, const HeadReading& reading) {
  const std::size_t element = reading.header.volume ? 16 : 12;
  return window.ensure(reading.bytes + 4 + element) && (reading.order.word(window.data() + reading.bytes) & 1) == 0;
}

}  // namespace

BlockHead read_block_head(ByteWindow& window, bool volume) {
  if (!window.ensure(4)) fail(Fault::kTruncated, "file ends inside the header", "0");
  const auto byte = [&](std::size_t i) { return std::to_integer<unsigned>(window.data()[i]); };
  if (byte(1) > 1) fail(Fault::kBadHeader, "byte order mark " + std::to_string(byte(1)) + " is neither 0 nor 1", "1");
  for (std::size_t i = 2; i < 4; ++i)
    if (byte(i) != 0)
      fail(Fault::kUnsupported, "compression " + std::to_string(byte(i)) + " is not known", std::to_string(i));

  const WordOrder declared = WordOrder::big_endian(byte(1) == 1), other{!declared.swapped};
  HeadReading first = HeadParser(window, declared, volume).parse();
  HeadReading second = HeadParser(window, other, volume).parse();
  const std::uint64_t first_bad = Judge(window, first).badness();
  const std::uint64_t second_bad = Judge(window, second).badness();
  if (first_bad == kImplausible && second_bad == kImplausible)
    fail(first.truncated ? Fault::kTruncated : Fault::kBadHeader, first.fault, std::to_string(first.bytes));

  const bool overruled = first_bad > second_bad;
  HeadReading& chosen = overruled ? second : first;
  chosen.header.post_order = judge_post_order(window, chosen);
  chosen.header.format +=
      WordOrder::big_endian(true).swapped == chosen.order.swapped ? " big endian" : " little endian";
  window.skip(chosen.bytes);
  return {std::move(chosen.header), chosen.order, overruled};
}

}  // namespace reeb::io
