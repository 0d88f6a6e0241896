// Buffered output of the streaming mesh writers, and the checks that they share.
#pragma once

#include <bit>
#include <cstdint>
#include <ostream>
#include <string>

#include "io/events/stream_event.h"

namespace reeb::io {

class StreamOutput {
 public:
  explicit StreamOutput(std::ostream& out) : out_(out) {}

  // To append to; call flush_if_full() now and then.
  std::string& text() { return text_; }
  void append_word(std::uint32_t word) {  // little endian
    for (unsigned shift = 0; shift < 32; shift += 8) text_.push_back(static_cast<char>((word >> shift) & 0xFF));
  }
  void append_float(float value) { append_word(std::bit_cast<std::uint32_t>(value)); }
  void flush_if_full() {
    if (text_.size() >= (1u << 16)) flush();
  }
  void flush();
  // THROWS: Error{kResource} if anything could not be written.
  void finish();
  std::ostream& stream() { return out_; }

 private:
  std::ostream& out_;
  std::string text_;
};

// THROWS: Error{kBadInput} if a cell is not of the kind that the file holds.
void require_cell_kind(EventKind kind, bool volume);
[[noreturn]] void fail_format(const std::string& what, const std::string& hint);

}  // namespace reeb::io
