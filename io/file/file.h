// A file by its descriptor: complete reads and writes at an offset, and errors that say what to do.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace reeb::io {

// Whether `path` names a regular file: not a pipe, a folder or nothing.
bool is_regular_file(const std::string& path);
// The name of standard output.
inline constexpr const char* kStandardOutput = "-";
// Its name in messages.
inline constexpr const char* kStandardOutputShown = "standard output";
inline constexpr const char* kStandardInputShown = "standard input";
// Whether the output `path` is standard output, a device, a FIFO or a socket: something that is written to and not
// replaced.
bool is_device(const std::string& path);

// The folder that holds `path`.
std::string folder_of(const std::string& path);

// Visits the names in `folder`, without "." and ".."; none if it cannot be read. `visit` may remove what it is given.
// The iterators of std::filesystem end the process when memory is out; this allocates nothing with operator new.
void for_each_name(const std::string& folder, const std::function<void(const char*)>& visit);

// Returns once the names in `folder` are on the device, as far as the file system can tell.
// THROWS: Error{kResource}.
void sync_folder(const std::string& folder);

// Part of a file in the address space, for reading; the destructor unmaps it.
class Mapping {
 public:
  Mapping() = default;
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  ~Mapping();

  std::span<const std::byte> bytes() const { return bytes_; }
  // Tells the system not to read pages around the one that is touched.
  void expect_random_access() const noexcept;
  // Returns the touched pages to the system, which reads them again when needed.
  void release_pages() const noexcept;

 private:
  friend class File;
  std::span<const std::byte> bytes_;
};

// How the hint ends of an error at a temporary file. Whoever has no such option, or another file, replaces these words.
inline constexpr const char* kOtherTempFolderHint = "choose another with --temp-dir DIR";

// Move-only owner of an open file, which the destructor closes. Reads and writes name their offset. They transfer
// everything or throw, and continue after signals.
//
// THROWS: Error with file and byte offset. For an input kBadInput, also if it ends too early. For other files
//         kResource, with a hint at what is needed (after a full disk, a quota, or a failing device).
// THREADS: any number may read and write ranges that do not overlap.
class File {
 public:
  enum class Use { kInput, kTemporary, kOutput };  // what errors say and advise

  File() = default;
  // Takes over `descriptor`, also if memory is out. `path` names the file in messages, even if it was unlinked.
  File(int descriptor, const std::string& path, Use use);
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();

  // An input. THROWS: Error{kBadInput} if it is missing, cannot be read, or is not a regular file.
  static File open_for_reading(const std::string& path);
  // A file that this program made. THROWS: Error{kBadInput} if it cannot be opened, or is a link.
  static File open_for_update(const std::string& path);
  // A new file of this program, for this user only. It replaces a file of that name; anything else of that name stays,
  // and is an error. THROWS: Error{kResource}.
  static File create(const std::string& path);

  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }
  std::uint64_t size() const;

  void read_at(std::uint64_t offset, std::span<std::byte> bytes) const;
  void write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // Writes at the current position of the descriptor, since a pipe has no other. `offset` is only for messages.
  void write_next(std::uint64_t offset, std::span<const std::byte> bytes) const;
  // REQUIRES: `offset` is a multiple of the page size; bytes > 0, and the file has them.
  Mapping map(std::uint64_t offset, std::size_t bytes) const;
  // Returns once the content is on the device.
  void sync() const;
  // Starts to bring these bytes of an output there, so that sync() need not wait for them. For other files, nothing.
  void start_sync(std::uint64_t offset, std::uint64_t bytes) const noexcept;

  // Throws the Error for the system's error number `error`, which occurred while `doing` ("write").
  [[noreturn]] void fail(const char* doing, int error, std::uint64_t offset, std::size_t bytes) const;

 private:
  int descriptor_ = -1;
  std::string path_;
  Use use_ = Use::kTemporary;
};

// The advice for the system's error number `error`: about a limit that was reached, or else `otherwise`.
std::string hint_for(int error, const std::string& otherwise);

// Throws the Error for an input that cannot be opened: kResource if a limit was reached, else kBadInput.
[[noreturn]] void throw_input_error(int error, const std::string& path);
// Throws Error{kResource}: the output `path` cannot be written, for the system's error number `error` (0: unknown).
[[noreturn]] void throw_output_error(int error, const std::string& path, const std::string& position = {});

}  // namespace reeb::io
