// The bytes of an input in order, wherever they come from: a mapped file, a compressed one, a pipe.
//
// Compression is told by content (gzip 1F 8B, zstd 28 B5 2F FD), never by name, and undone on the
// way; everything behind this interface sees the content only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace reeb::io {

class MappableFile;

class ContentSource {
 public:
  // What a view holds at least where nothing else is said, or all that is left.
  static constexpr std::size_t kLookahead = 65536;

  ContentSource() = default;
  ContentSource(const ContentSource&) = delete;
  ContentSource& operator=(const ContentSource&) = delete;
  virtual ~ContentSource() = default;

  // The content from `offset` on, at least `least` bytes unless it ends before; empty at the end.
  // Ends the validity of the view before. Offsets never fall, except where can_seek(). A pipe is
  // waited for until `least` bytes have come, and no longer.
  // REQUIRES: 1 <= least <= kLookahead.
  // THROWS: Error{kBadInput} where a compressed stream is damaged or cut.
  virtual std::string_view view(std::uint64_t offset, std::size_t least) = 0;
  std::string_view view(std::uint64_t offset) { return view(offset, kLookahead); }

  virtual bool can_seek() const = 0;
  // Bytes of content, where known without reading it.
  virtual std::optional<std::uint64_t> size() const = 0;
  // Bytes of the file as it lies on disk: consumed so far for the views given out, and in all
  // (0: unknown).
  virtual std::uint64_t file_bytes_read() const = 0;
  virtual std::uint64_t file_bytes() const = 0;

  // The file, where the content is that of an uncompressed one: it can be mapped without opening it again.
  // Else null.
  virtual std::shared_ptr<const MappableFile> file() const { return nullptr; }

  // What error messages call it.
  const std::string& name() const { return name_; }

 protected:
  explicit ContentSource(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

// "-" is standard input. A source that is not a regular file is read as a pipe.
// THROWS: Error{kBadInput}: absent, a directory, unreadable, empty.
std::unique_ptr<ContentSource> open_content(const std::string& path);
// The same for a file that is open.
std::unique_ptr<ContentSource> open_content(std::shared_ptr<const MappableFile> file);

}  // namespace reeb::io
