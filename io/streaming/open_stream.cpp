#include "io/streaming/open_stream.h"

#include <algorithm>
#include <cstring>

#include "io/events/stream_fault.h"
#include "io/smc/smc_reader.h"
#include "io/streaming/block_reader.h"
#include "io/streaming/text_reader.h"

namespace reeb::io {
namespace {

// A source whose first bytes were read already.
class PeekedSource : public ByteSource {
 public:
  explicit PeekedSource(std::unique_ptr<ByteSource> rest) : rest_(std::move(rest)) {
    while (count_ < peeked_.size()) {
      const std::size_t got = rest_->read(std::span(peeked_).subspan(count_));
      if (got == 0) break;
      count_ += got;
    }
  }
  std::span<const std::byte> peeked() const { return std::span(peeked_).first(count_); }

  std::size_t read(std::span<std::byte> out) override {
    if (at_ == count_) return rest_->read(out);
    const std::size_t size = std::min(out.size(), count_ - at_);
    std::memcpy(out.data(), peeked_.data() + at_, size);
    at_ += size;
    return size;
  }
  std::uint64_t consumed() const override { return rest_->consumed(); }
  std::optional<std::uint64_t> size() const override { return rest_->size(); }

 private:
  std::unique_ptr<ByteSource> rest_;
  std::array<std::byte, 2> peeked_{};
  std::size_t count_ = 0, at_ = 0;
};

// The suffix before .gz or .zst.
bool has_suffix(std::string name, const std::string& suffix) {
  for (const char* wrapper : {".gz", ".zst"})
    if (name.ends_with(wrapper)) name.resize(name.size() - std::strlen(wrapper));
  return name.ends_with(suffix);
}

bool is_text(unsigned byte) { return byte == '\t' || byte == '\n' || byte == '\r' || (byte >= 0x20 && byte < 0x7F); }

std::string hexadecimal(unsigned byte) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  return {'0', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

[[noreturn]] void refuse(const std::string& what) {
  fail(Fault::kUnsupported, "this is " + what + "; only SMA, SMB, SMC (versions 1 and 3), SVA and SVB are read", "0");
}

}  // namespace

bool looks_like_binary_stream(std::byte first) { return std::to_integer<unsigned>(first) <= 4; }

std::unique_ptr<EventReader> open_stream(std::unique_ptr<ByteSource> source, const std::string& name) {
  auto input = std::make_unique<PeekedSource>(std::move(source));
  const auto peeked = input->peeked();
  if (peeked.empty()) fail(Fault::kTruncated, "the file is empty", "0");
  const auto first = std::to_integer<unsigned>(peeked[0]);
  const bool has_second = peeked.size() > 1;
  const unsigned second = has_second ? std::to_integer<unsigned>(peeked[1]) : 0;

  if (has_suffix(name, ".svc")) refuse("a compressed volume mesh (SVC)");
  if (first == 0x1F && second == 0x8B) refuse("gzip-compressed");
  if (is_text(first)) return std::make_unique<TextEventReader>(std::move(input), has_suffix(name, ".sva"));
  switch (first) {
    case 0:
      return std::make_unique<SmbEventReader>(std::move(input));
    case 1:
      if (has_second && second != 1) refuse("an old SMC (2003) file");
      return std::make_unique<SmcEventReader>(std::move(input));
    case 2:
      refuse("an SMD file");
    case 3:
      return std::make_unique<SmcEventReader>(std::move(input));
    case 4:
      return std::make_unique<SvbEventReader>(std::move(input));
    default:
      refuse("no streaming mesh (first byte " + hexadecimal(first) + ")");
  }
}

}  // namespace reeb::io
