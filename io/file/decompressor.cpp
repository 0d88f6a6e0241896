#include "io/file/decompressor.h"

#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <boost/iostreams/read.hpp>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "io/file/file_name.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

namespace bio = boost::iostreams;

constexpr std::streamsize kChunkBytes = 65536;

struct Damaged {
  std::string what;
  bool is_cut = false;
};

// The raw bytes as a Boost.Iostreams device.
class RawDevice {
 public:
  using char_type = char;
  using category = bio::source_tag;

  explicit RawDevice(RawInput* raw) : raw_(raw) {}

  std::streamsize read(char* out, std::streamsize limit) {
    const std::size_t got = raw_->read(out, static_cast<std::size_t>(limit));
    return got == 0 ? -1 : static_cast<std::streamsize>(got);
  }

 private:
  RawInput* raw_;
};

// THROWS: std::bad_alloc.
std::shared_ptr<z_stream> make_gzip_stream() {
  auto stream = std::make_unique<z_stream>();
  constexpr int kGzip = 16;  // zlib: 16 + window bits means a gzip header
  if (inflateInit2(stream.get(), MAX_WBITS + kGzip) != Z_OK) throw std::bad_alloc();
  return {stream.release(), [](z_stream* open) {
            inflateEnd(open);
            delete open;
          }};
}

// bio::gzip_decompressor refuses zeros after the last member, with which tapes fill a block.
class GzipFilter {
 public:
  using char_type = char;
  struct category : bio::multichar_input_filter_tag {};

  explicit GzipFilter(std::shared_ptr<z_stream> stream) : stream_(std::move(stream)), chunk_(kChunkBytes) {}

  template <class Source>
  std::streamsize read(Source& source, char* out, std::streamsize limit) {
    stream_->next_out = reinterpret_cast<Bytef*>(out);
    stream_->avail_out = static_cast<uInt>(limit);
    while (stream_->avail_out == static_cast<uInt>(limit)) {
      if (stream_->avail_in == 0 && !fill(source)) {
        if (place_ == Place::kInMember) throw Damaged{"is not a whole gzip stream", true};
        return -1;
      }
      if (place_ == Place::kInMember)
        inflate_more();
      else
        pass_end();
    }
    return limit - static_cast<std::streamsize>(stream_->avail_out);
  }

 private:
  enum class Place { kInMember, kAfterMember, kInPadding };

  template <class Source>
  bool fill(Source& source) {
    const std::streamsize got = bio::read(source, chunk_.data(), kChunkBytes);
    stream_->next_in = reinterpret_cast<Bytef*>(chunk_.data());
    stream_->avail_in = got > 0 ? static_cast<uInt>(got) : 0;
    return got > 0;
  }

  void inflate_more() {
    const int result = inflate(stream_.get(), Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result == Z_STREAM_END) place_ = Place::kAfterMember;
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)
      throw Damaged{"is not a whole gzip stream", false};
  }

  // At a byte after a member: it begins another one, or all that follows is zero.
  void pass_end() {
    constexpr Bytef kFirstOfMember = 0x1F;
    if (place_ == Place::kAfterMember && *stream_->next_in == kFirstOfMember) {
      inflateReset(stream_.get());
      place_ = Place::kInMember;
      return;
    }
    place_ = Place::kInPadding;
    for (; stream_->avail_in != 0; ++stream_->next_in, --stream_->avail_in)
      if (*stream_->next_in != 0) throw Damaged{"there are bytes after the last member of a gzip stream", false};
  }

  std::shared_ptr<z_stream> stream_;  // Boost copies its filters
  std::vector<char> chunk_;
  Place place_ = Place::kInMember;
};

// THROWS: std::bad_alloc.
std::shared_ptr<ZSTD_DStream> make_zstd_stream() {
  std::shared_ptr<ZSTD_DStream> stream(ZSTD_createDStream(), &ZSTD_freeDStream);
  if (!stream) throw std::bad_alloc();
  return stream;
}

// THROWS: Damaged; an Error without a file; or std::bad_alloc.
void check_zstd(std::size_t result) {
  if (ZSTD_isError(result) == 0) return;
  const ZSTD_ErrorCode code = ZSTD_getErrorCode(result);
  if (code == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (code == ZSTD_error_frameParameter_windowTooLarge)
    throw Error(ErrorKind::kBadInput, "unpacking it takes a larger window than zstd allows",
                "unpack it first, with zstd -d and its option for long windows");
  throw Damaged{ZSTD_getErrorName(result)};
}

// bio::zstd_decompressor accepts a truncated stream as complete, so this filter follows the frames itself.
class ZstdFilter {
 public:
  using char_type = char;
  struct category : bio::multichar_input_filter_tag {};

  explicit ZstdFilter(std::shared_ptr<ZSTD_DStream> stream) : stream_(std::move(stream)), chunk_(kChunkBytes) {}

  template <class Source>
  std::streamsize read(Source& source, char* out, std::streamsize limit) {
    ZSTD_outBuffer produced{out, static_cast<std::size_t>(limit), 0};
    while (produced.pos == 0) {
      if (given_.pos == given_.size && !flushing_) {
        const std::streamsize got = bio::read(source, chunk_.data(), kChunkBytes);
        if (got <= 0) {
          if (inside_frame_) throw Damaged{"ends inside a zstd frame", true};
          return -1;
        }
        given_ = {chunk_.data(), static_cast<std::size_t>(got), 0};
      }
      const std::size_t wanted = ZSTD_decompressStream(stream_.get(), &produced, &given_);
      check_zstd(wanted);
      inside_frame_ = wanted != 0;
      flushing_ = inside_frame_ && produced.pos == produced.size;
    }
    return static_cast<std::streamsize>(produced.pos);
  }

 private:
  std::shared_ptr<ZSTD_DStream> stream_;  // Boost copies its filters
  std::vector<char> chunk_;
  ZSTD_inBuffer given_{nullptr, 0, 0};
  bool inside_frame_ = true;  // the last frame is not complete; there is one at least
  bool flushing_ = false;     // more output may be waiting without more input
};

class DecompressedInput final : public RawInput {
 public:
  DecompressedInput(std::string name, std::unique_ptr<RawInput> raw, Compression compression)
      : name_(std::move(name)), raw_(std::move(raw)) {
    if (compression == Compression::kGzip) {
      chain_.push(GzipFilter(make_gzip_stream()), kChunkBytes);
    } else {
      zstd_ = make_zstd_stream();
      chain_.push(ZstdFilter(zstd_), kChunkBytes);
    }
    chain_.push(RawDevice(raw_.get()), kChunkBytes);
  }

  std::size_t read(char* out, std::size_t limit) override {
    try {
      const std::streamsize got = bio::read(chain_, out, static_cast<std::streamsize>(limit));
      return got < 0 ? 0 : static_cast<std::size_t>(got);
    } catch (Error& failure) {
      if (failure.file().empty()) failure.at(name_);
      throw;
    } catch (const Damaged& damage) {
      throw_damaged(damage.what, damage.is_cut);
    }
  }

  std::uint64_t consumed() const override { return raw_->consumed(); }
  std::uint64_t memory_bytes() const override { return zstd_ ? ZSTD_sizeof_DStream(zstd_.get()) : 0; }

 private:
  // Errors of streaming meshes have a class.
  [[noreturn]] void throw_damaged(const std::string& reason, bool is_cut) const {
    const std::string fault = !is_streaming_name(name_) ? "" : is_cut ? "TRUNCATED: " : "UNSUPPORTED: ";
    throw Error(ErrorKind::kBadInput, fault + "the compressed data are damaged or cut: " + reason,
                "fetch or compress the file again; gzip -t and zstd -t check one")
        .at(name_, std::to_string(raw_->consumed()));
  }

  std::string name_;
  std::unique_ptr<RawInput> raw_;
  std::shared_ptr<ZSTD_DStream> zstd_;  // null if the input is packed with gzip
  bio::filtering_streambuf<bio::input> chain_;
};

}  // namespace

Compression detect_compression(std::string_view first_bytes, const std::string& name) {
  static constexpr std::string_view kGzipMagic = "\x1F\x8B", kZstdMagic = "\x28\xB5\x2F\xFD";
  const std::string suffix = name_suffix(name);
  const auto starts = [&](std::string_view magic, std::string_view with_suffix) {
    return first_bytes.starts_with(magic) || (magic.starts_with(first_bytes) && suffix == with_suffix);
  };
  if (starts(kGzipMagic, ".gz")) return Compression::kGzip;
  if (starts(kZstdMagic, ".zst")) return Compression::kZstd;
  return Compression::kNone;
}

std::unique_ptr<RawInput> decompress(const std::string& name, std::unique_ptr<RawInput> raw, Compression compression) {
  if (compression == Compression::kNone) return raw;
  return std::make_unique<DecompressedInput>(name, std::move(raw), compression);
}

}  // namespace reeb::io
