#include "io/decoding/hex_input.h"

#include <utility>
#include <vector>

#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "io/text/words.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

class HexInput final : public ByteFilter {
 public:
  explicit HexInput(std::unique_ptr<ByteInput> text) : ByteFilter(std::move(text)), buffer_(65536) {}

  std::uint64_t offset() const override { return ByteFilter::offset() - (filled_ - next_); }

  std::size_t read(char* out, std::size_t limit) override {
    std::size_t done = 0;
    while (done < limit) {
      const int high = next_digit(), low = high < 0 ? -1 : next_digit();
      if (low < 0) break;
      out[done++] = static_cast<char>(high * 16 + low);
    }
    return done;
  }

 private:
  // -1 at the end.
  int next_digit() {
    for (;;) {
      if (next_ == filled_) {
        next_ = 0;
        filled_ = input().read(buffer_.data(), buffer_.size());
        if (filled_ == 0) return -1;
      }
      const char c = buffer_[next_];
      const int digit = hex_digit(c);
      if (digit < 0 && !is_blank_or_line_end(c))
        throw Error(ErrorKind::kBadInput, "not a hexadecimal digit", kCutOrDamagedHereHint)
            .at(name(), std::to_string(offset()));
      ++next_;
      if (digit >= 0) return digit;
    }
  }

  std::vector<char> buffer_;
  std::size_t next_ = 0, filled_ = 0;
};

}  // namespace

std::unique_ptr<ByteInput> from_hex(std::unique_ptr<ByteInput> text) {
  return std::make_unique<HexInput>(std::move(text));
}

}  // namespace reeb::io
