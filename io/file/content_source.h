// The bytes of an input in order: from a file, a compressed one, or a pipe.
//
// Compression is detected from the content (gzip 1F 8B, zstd 28 B5 2F FD), never from the name. Users of this interface
// see the decompressed content only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace reeb::io {

class InputFile;
enum class Empty;

class ContentSource {
 public:
  // The least number of bytes in a view, unless another number is given or the content ends before.
  static constexpr std::size_t kLookahead = 65536;

  ContentSource() = default;
  ContentSource(const ContentSource&) = delete;
  ContentSource& operator=(const ContentSource&) = delete;
  virtual ~ContentSource() = default;

  // The content from `offset` on: at least `min_bytes`, unless it ends before; empty at the end. Invalidates the
  // previous view. On a pipe it waits until `min_bytes` have arrived, and no longer.
  // REQUIRES: 1 <= min_bytes <= kLookahead; `offset` is not below the previous one, unless can_seek().
  // THROWS: Error{kBadInput} where a compressed stream is damaged or cut.
  virtual std::string_view view(std::uint64_t offset, std::size_t min_bytes) = 0;
  std::string_view view(std::uint64_t offset) { return view(offset, kLookahead); }

  virtual bool can_seek() const = 0;
  // The least offset that the next view can have: 0, or that of the last view if it cannot seek.
  virtual std::uint64_t least_offset() const { return 0; }
  // Bytes of content, if known without reading it.
  virtual std::optional<std::uint64_t> size() const = 0;
  // Bytes of the file as stored on disk: those consumed so far, and all of them (0: unknown).
  virtual std::uint64_t file_bytes_read() const = 0;
  virtual std::uint64_t file_bytes() const = 0;

  // The file, if it is uncompressed: it can be read at any place without being opened again. Else null.
  virtual std::shared_ptr<const InputFile> file() const { return nullptr; }

  // The same content from its beginning, read independently of this; it is unpacked again if it is packed. Null if the
  // content can be read only once (a pipe).
  virtual std::unique_ptr<ContentSource> reopen() const { return nullptr; }

  // What it holds to unpack its content, as far as is known from what was read.
  virtual std::uint64_t memory_bytes() const { return 0; }

  // Its name in error messages.
  const std::string& name() const { return name_; }

 protected:
  explicit ContentSource(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

// "-" is standard input. A source that is not a regular file is read as a pipe.
// THROWS: Error{kBadInput}: absent, a directory, unreadable, empty.
std::unique_ptr<ContentSource> open_content(const std::string& path);
// The same for an open file.
std::unique_ptr<ContentSource> open_content(std::shared_ptr<const InputFile> file);
// An uncompressed file that is read in small pieces here and there: reading some bytes costs less than a window.
std::unique_ptr<ContentSource> open_for_seeking(std::shared_ptr<const InputFile> file);
// As content.reopen(), but what is not packed is opened for seeking: where many places are read at a time, a window for
// each costs more than what is read there.
std::unique_ptr<ContentSource> reopen_for_seeking(const ContentSource& content);

// A source of the same content, from its beginning, which was copied to a temporary file without a name in
// `temp_folder` (temp_dir.h); views of at most kLookahead bytes may have been taken.
std::unique_ptr<ContentSource> copy_content(ContentSource& source, const std::string& temp_folder);
// The source itself if it can be reopened, else such a copy.
std::unique_ptr<ContentSource> make_reopenable(std::unique_ptr<ContentSource> source, const std::string& temp_folder);

// An input that can be opened repeatedly, the same file each time, even if its name is removed or replaced.
class Input {
 public:
  // `beside`: other files that are read with it, and must not change either.
  // THROWS: as open_content().
  explicit Input(std::string path, const std::vector<std::string>& beside = {});
  Input(std::string path, const std::vector<std::string>& beside, Empty empty);

  const std::string& path() const { return path_; }
  // Its content from the start. A pipe has it once.
  std::unique_ptr<ContentSource> open() const;
  // Whether it is a file, and no pipe.
  bool can_reopen() const { return file_ != nullptr; }
  // As InputFile; a pipe cannot change.
  void check_unchanged(const char* content = "the mesh") const;

  // Returns what work() returns, if anything. Whatever goes wrong with an input that changes is due to the change.
  // THROWS: Error{kChanged} if it changed, whether work() threw or not; else what work() throws.
  template <class Work>
  auto read(const Work& work) const {
    try {
      if constexpr (std::is_void_v<decltype(work())>) {
        work();
        check_unchanged();
      } else {
        auto result = work();
        check_unchanged();
        return result;
      }
    } catch (const std::exception&) {
      check_unchanged();
      throw;
    }
  }

 private:
  std::string path_;
  Empty empty_;
  std::shared_ptr<const InputFile> file_;  // null if it is a pipe
  std::vector<std::shared_ptr<const InputFile>> beside_;
};

}  // namespace reeb::io
