#include "io/decoding/base64_input.h"

#include <array>
#include <utility>
#include <vector>

#include "io/text/hints.h"
#include "io/text/text_cursor.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// The number of each digit; -1 for other characters.
constexpr auto kDigits = [] {
  std::array<int, 256> digits{};
  digits.fill(-1);
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kAlphabet.size(); ++i)
    digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<int>(i);
  return digits;
}();

class Base64Input final : public ByteFilter {
 public:
  explicit Base64Input(std::unique_ptr<ByteInput> text) : ByteFilter(std::move(text)), buffer_(65536) {}

  std::uint64_t offset() const override { return ByteFilter::offset() - (filled_ - next_); }

  std::size_t read(char* out, std::size_t limit) override {
    std::size_t done = 0;
    while (done < limit) {
      if (given_ == decoded_ && !decode_group()) break;
      while (done < limit && given_ < decoded_) out[done++] = group_[given_++];
    }
    return done;
  }

 private:
  // Whether there are bytes in group_.
  bool decode_group() {
    std::uint32_t bits = 0;
    unsigned pads = 0;
    for (unsigned symbols = 0; symbols < 4;) {
      if (next_ == filled_ && !refill()) return false;
      const char c = buffer_[next_];
      const int digit = kDigits[static_cast<unsigned char>(c)];
      if (c == '<') return false;
      const bool pad = c == '=' && symbols >= 2;
      if (digit >= 0 && pads == 0)
        bits = bits << 6 | static_cast<std::uint32_t>(digit);
      else if (pad)
        bits <<= 6, ++pads;
      else if (!is_blank_or_line_end(c))
        throw Error(ErrorKind::kBadInput, "this is not base64 text", kCutOrDamagedHereHint)
            .at(name(), std::to_string(offset()));
      ++next_;
      if (digit >= 0 || pad) ++symbols;
    }
    for (unsigned i = 0; i < 3; ++i) group_[i] = static_cast<char>(bits >> (16 - 8 * i));
    given_ = 0;
    decoded_ = 3 - pads;
    return true;
  }

  bool refill() {
    next_ = 0;
    filled_ = input().read(buffer_.data(), buffer_.size());
    return filled_ != 0;
  }

  std::vector<char> buffer_;
  std::size_t next_ = 0, filled_ = 0;
  std::array<char, 3> group_{};
  unsigned given_ = 0, decoded_ = 0;
};

}  // namespace

std::unique_ptr<ByteInput> from_base64(std::unique_ptr<ByteInput> text) {
  return std::make_unique<Base64Input>(std::move(text));
}

}  // namespace reeb::io
