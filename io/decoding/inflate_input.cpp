#include "io/decoding/inflate_input.h"

#include <zlib.h>

#include <new>
#include <utility>
#include <vector>

#include "io/text/hints.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

constexpr std::size_t kChunkBytes = 65536;
constexpr int kZlibOrGzip = 15 + 32;

class InflateInput final : public ByteFilter {
 public:
  explicit InflateInput(std::unique_ptr<ByteInput> packed) : ByteFilter(std::move(packed)), chunk_(kChunkBytes) {
    if (inflateInit2(&stream_, kZlibOrGzip) != Z_OK) throw std::bad_alloc();
  }
  ~InflateInput() override { inflateEnd(&stream_); }

  std::uint64_t offset() const override { return ByteFilter::offset() - stream_.avail_in; }

  std::size_t read(char* out, std::size_t limit) override {
    if (limit > kChunkBytes) limit = kChunkBytes;
    stream_.next_out = reinterpret_cast<Bytef*>(out);
    stream_.avail_out = static_cast<uInt>(limit);
    while (stream_.avail_out == limit && !ended_) {
      if (stream_.avail_in == 0 && !refill()) fail("the packed data end too early");
      const bool first = stream_.total_in == 0;
      if (first) gzip_ = *stream_.next_in == 0x1F;
      const int state = ::inflate(&stream_, Z_NO_FLUSH);
      if (state == Z_STREAM_END)
        ended_ = !begins_another_member();
      else if (state == Z_MEM_ERROR)
        throw std::bad_alloc();
      else if (state != Z_OK && state != Z_BUF_ERROR)
        fail(stream_.msg == nullptr ? "the packed data are damaged"
                                    : std::string("the packed data are damaged: ") + stream_.msg);
    }
    return limit - stream_.avail_out;
  }

 private:
  bool refill() {
    const std::size_t got = input().read(chunk_.data(), chunk_.size());
    stream_.next_in = reinterpret_cast<Bytef*>(chunk_.data());
    stream_.avail_in = static_cast<uInt>(got);
    return got != 0;
  }

  bool begins_another_member() {
    if (!gzip_ || (stream_.avail_in == 0 && !refill()) || *stream_.next_in != 0x1F) return false;
    inflateReset(&stream_);
    return true;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::kBadInput, what, kCutOrDamagedHint).at(name(), std::to_string(offset()));
  }

  z_stream stream_{};
  std::vector<char> chunk_;
  bool gzip_ = false;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<ByteInput> inflate(std::unique_ptr<ByteInput> packed) {
  return std::make_unique<InflateInput>(std::move(packed));
}

}  // namespace reeb::io
