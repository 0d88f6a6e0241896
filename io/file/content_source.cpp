#include "io/file/content_source.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/file/decompressor.h"
#include "io/file/file_windows.h"
#include "io/file/input_file.h"
#include "io/file/system.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"

namespace reeb::io {
namespace {

// How much of a file is read at a time: `following` right after the last piece, and `first` elsewhere, where little may
// be needed.
struct PieceBytes {
  std::size_t following, first;
};
constexpr PieceBytes kInOrder = {256 << 10, 256 << 10}, kHereAndThere = {ContentSource::kLookahead, 16384};

// A file through one window, which moves to where it is needed. Of a file that is read from its beginning to its end,
// each byte is copied from the system once.
class FileSource final : public ContentSource {
 public:
  FileSource(const std::string& name, std::shared_ptr<const InputFile> file, const PieceBytes& pieces)
      : ContentSource(name),
        file_(std::move(file)),
        pieces_(pieces),
        window_(static_cast<std::size_t>(std::min<std::uint64_t>(pieces.following, file_->size()))) {}
  using ContentSource::view;

  std::string_view view(std::uint64_t offset, std::size_t min_bytes) override {
    offset = read_ = std::min(offset, file_->size());
    const std::uint64_t needed = std::min<std::uint64_t>(min_bytes, file_->size() - offset);
    if (offset < begin_ || offset + needed > begin_ + filled_) move_to(offset, min_bytes);
    const auto skip = static_cast<std::size_t>(offset - begin_);
    return {window_.data() + skip, filled_ - skip};
  }
  bool can_seek() const override { return true; }
  std::optional<std::uint64_t> size() const override { return file_->size(); }
  std::uint64_t file_bytes_read() const override { return read_; }
  std::uint64_t file_bytes() const override { return file_->size(); }
  std::shared_ptr<const InputFile> file() const override { return file_; }
  std::unique_ptr<ContentSource> reopen() const override {
    return std::make_unique<FileSource>(name(), file_, pieces_);
  }

 private:
  void move_to(std::uint64_t offset, std::size_t min_bytes) {
    const bool follows = offset >= begin_ && offset <= begin_ + filled_;
    const auto kept = follows ? static_cast<std::size_t>(begin_ + filled_ - offset) : 0;
    std::memmove(window_.data(), window_.data() + filled_ - kept, kept);
    const std::size_t wanted = follows ? pieces_.following : std::max(min_bytes, pieces_.first);
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(wanted, file_->size() - offset));
    filled_ = 0;  // if it cannot be read
    file_->read_at(offset + kept, std::as_writable_bytes(std::span(window_).first(bytes).subspan(kept)));
    begin_ = offset;
    filled_ = bytes;
  }

  std::shared_ptr<const InputFile> file_;
  const PieceBytes pieces_;
  std::vector<char> window_;
  std::uint64_t begin_ = 0, read_ = 0;
  std::size_t filled_ = 0;
};

// A file as the sequential input of a decompressor.
class FileInput final : public RawInput {
 public:
  explicit FileInput(std::shared_ptr<const InputFile> file) : windows_(std::move(file), {.window_count = 2}) {}

  std::size_t read(char* out, std::size_t limit) override {
    if (offset_ == windows_.size()) return 0;
    const auto bytes = windows_.view(offset_).substr(0, limit);
    std::memcpy(out, bytes.data(), bytes.size());
    offset_ += bytes.size();
    return bytes.size();
  }
  std::uint64_t consumed() const override { return offset_; }

 private:
  FileWindows windows_;
  std::uint64_t offset_ = 0;
};

class PipeInput final : public RawInput {
 public:
  PipeInput(std::string name, int descriptor, bool owned)
      : name_(std::move(name)), descriptor_(descriptor), owned_(owned) {}
  ~PipeInput() override {
    if (owned_) ::close(descriptor_);
  }

  std::size_t read(char* out, std::size_t limit) override {
    const auto got = system::read_some(descriptor_, std::as_writable_bytes(std::span(out, limit)));
    if (got.error != 0)
      throw Error(ErrorKind::kBadInput, std::string("cannot be read: ") + std::strerror(got.error),
                  "check what is connected to the input")
          .at(name_);
    consumed_ += got.bytes;
    return got.bytes;
  }
  std::uint64_t consumed() const override { return consumed_; }

 private:
  std::string name_;
  int descriptor_;
  bool owned_;
  std::uint64_t consumed_ = 0;
};

// A stream without random access, through a sliding buffer.
class StreamSource final : public ContentSource {
 public:
  // `file` is the packed file; null for a pipe.
  StreamSource(const std::string& name, std::unique_ptr<RawInput> input, std::shared_ptr<const InputFile> file)
      : ContentSource(name), input_(std::move(input)), file_(std::move(file)), buffer_(kBufferBytes) {}

  std::string_view view(std::uint64_t offset, std::size_t min_bytes) override {
    // The offset comes from the reader's own arithmetic, never from the file.
    if (offset < begin_) throw std::logic_error("a view begins before the last one");
    const std::size_t skip = std::min(static_cast<std::size_t>(offset - begin_), filled_);
    filled_ -= skip;
    begin_ += skip;
    if (ended_ || filled_ >= min_bytes) {
      start_ += skip;
    } else {
      std::memmove(buffer_.data(), buffer_.data() + start_ + skip, filled_);
      start_ = 0;
      fill(min_bytes);
    }
    return {buffer_.data() + start_, filled_};
  }
  bool can_seek() const override { return false; }
  std::uint64_t least_offset() const override { return begin_; }
  std::optional<std::uint64_t> size() const override { return std::nullopt; }
  std::uint64_t file_bytes_read() const override { return input_->consumed(); }
  std::uint64_t file_bytes() const override { return file_ == nullptr ? 0 : file_->size(); }
  std::unique_ptr<ContentSource> reopen() const override { return file_ == nullptr ? nullptr : open_content(file_); }
  std::uint64_t memory_bytes() const override { return input_->memory_bytes(); }

 private:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

  void fill(std::size_t min_bytes) {
    while (filled_ < min_bytes && !ended_) {
      const std::size_t got = input_->read(buffer_.data() + filled_, buffer_.size() - filled_);
      ended_ = got == 0;
      filled_ += got;
    }
  }

  std::unique_ptr<RawInput> input_;
  std::shared_ptr<const InputFile> file_;
  std::vector<char> buffer_;
  std::uint64_t begin_ = 0;  // content offset of buffer_[start_]
  std::size_t start_ = 0, filled_ = 0;
  bool ended_ = false;
};

// The first bytes of a pipe, which were read to detect its compression, then the rest.
class PeekedInput final : public RawInput {
 public:
  explicit PeekedInput(std::unique_ptr<RawInput> input) : input_(std::move(input)) {
    while (filled_ < head_.size()) {
      const std::size_t got = input_->read(head_.data() + filled_, head_.size() - filled_);
      if (got == 0) break;
      filled_ += got;
    }
  }

  std::string_view head() const { return {head_.data(), filled_}; }

  std::size_t read(char* out, std::size_t limit) override {
    const std::size_t size = std::min(limit, filled_ - given_);
    if (size == 0) return input_->read(out, limit);
    std::memcpy(out, head_.data() + given_, size);
    given_ += size;
    return size;
  }
  std::uint64_t consumed() const override { return input_->consumed(); }

 private:
  std::unique_ptr<RawInput> input_;
  std::array<char, 4> head_{};
  std::size_t filled_ = 0, given_ = 0;
};

std::unique_ptr<ContentSource> stream_source(const std::string& name, std::unique_ptr<RawInput> raw, Empty empty,
                                             std::shared_ptr<const InputFile> file = nullptr) {
  auto peeked = std::make_unique<PeekedInput>(std::move(raw));
  const auto compression = detect_compression(peeked->head(), name);
  auto source = std::make_unique<StreamSource>(name, decompress(name, std::move(peeked), compression), std::move(file));
  if (source->view(0, 1).empty() && empty == Empty::kRefused) throw_empty(name);
  return source;
}

std::unique_ptr<RawInput> open_pipe(const std::string& path) {
  if (path == "-") return std::make_unique<PipeInput>(kStandardInputShown, STDIN_FILENO, false);
  const int descriptor = system::open(path, O_RDONLY);
  if (descriptor < 0) throw_input_error(errno, path);
  return std::make_unique<PipeInput>(path, descriptor, true);
}

}  // namespace

std::unique_ptr<ContentSource> open_content(std::shared_ptr<const InputFile> file) {
  auto plain = std::make_unique<FileSource>(file->path(), file, kInOrder);
  if (detect_compression(plain->view(0), file->path()) == Compression::kNone) return plain;
  return stream_source(file->path(), std::make_unique<FileInput>(file), file->empty(), file);
}

std::unique_ptr<ContentSource> make_reopenable(std::unique_ptr<ContentSource> source, const std::string& temp_folder) {
  return source->reopen() != nullptr ? std::move(source) : copy_content(*source, temp_folder);
}

std::unique_ptr<ContentSource> copy_content(ContentSource& source, const std::string& temp_folder) {
  File copy = TempDir(temp_folder).create_unnamed("input");
  std::uint64_t offset = 0;
  for (std::string_view bytes; !(bytes = source.view(offset, ContentSource::kLookahead)).empty();
       offset += bytes.size())
    copy.write_at(offset, std::as_bytes(std::span(bytes)));
  return std::make_unique<FileSource>(source.name(), std::make_shared<const InputFile>(std::move(copy)), kInOrder);
}

std::unique_ptr<ContentSource> open_for_seeking(std::shared_ptr<const InputFile> file) {
  const std::string& name = file->path();
  return std::make_unique<FileSource>(name, std::move(file), kHereAndThere);
}

std::unique_ptr<ContentSource> reopen_for_seeking(const ContentSource& content) {
  auto file = content.file();
  if (file == nullptr) return content.reopen();
  return std::make_unique<FileSource>(content.name(), std::move(file), kHereAndThere);
}

std::unique_ptr<ContentSource> open_content(const std::string& path) { return Input(path).open(); }

Input::Input(std::string path, const std::vector<std::string>& beside)
    : Input(std::move(path), beside, Empty::kRefused) {}

Input::Input(std::string path, const std::vector<std::string>& beside, Empty empty)
    : path_(std::move(path)), empty_(empty), file_(open_if_regular(path_, empty)) {
  for (const std::string& other : beside)
    if (auto file = open_if_regular(other)) beside_.push_back(std::move(file));
}

std::unique_ptr<ContentSource> Input::open() const {
  if (file_) return open_content(file_);
  const std::string name = path_ == "-" ? kStandardInputShown : path_;
  return stream_source(name, open_pipe(path_), empty_);
}

void Input::check_unchanged(const char* content) const {
  if (file_) file_->check_unchanged(content);
  for (const auto& file : beside_) file->check_unchanged(content);
}

}  // namespace reeb::io
