// The one way to write an output: a file that appears under its name only when it is whole.
//
// Bytes go to NAME.partial-PID-N in the same folder. commit() makes them durable and gives them their name in one
// step. Every other way out, exceptions included, removes them, and what had the name before is untouched; what a
// killed process left is removed by the next writer of the same output.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file/buffered_writer.h"

namespace reeb::io {

enum class Existing { kRefuse, kReplace };

// Says before any work that an output cannot have this name.
// THROWS: Error{kBadInput} as the constructor of AtomicFile.
void check_output_name(const std::string& path, Existing existing);

// The same for its folder. THROWS: Error{kResource} that names the folder of `path` if no file can be made there.
void require_output_folder(const std::string& path);

// Removes the temporary files that killed writers of `path` left; a living writer holds a lock on its
// own. AtomicFile does so itself.
void remove_abandoned(const std::string& path);

struct AtomicOptions {
  Existing existing = Existing::kRefuse;
  // The writer overwrites what it has appended. What goes to a device is then collected in a temporary file first.
  bool overwrites = false;
  std::size_t buffer_bytes = BufferedWriter::kBufferBytes;
};

// What `path` names decides what is written:
// - nothing, or a file: a new file. It has the mode of the file that it replaces, else what the umask leaves of 0666;
//   while it is written, only this user may read it.
// - a symbolic link: the file that the link leads to, which is made if it is missing. The link stays.
// - a device, a FIFO or a socket: that itself. Bytes are written into it as they come; it is never replaced.
//
// THROWS, from every call: Error{kResource} with the path: the folder is missing or cannot be written, the disk is
// full.
class AtomicFile {
 public:
  // THROWS: Error{kBadInput} if `path` exists and may not be replaced, is a folder, or is a link that leads nowhere but
  //         to itself.
  explicit AtomicFile(const std::string& path, const AtomicOptions& options = {});
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  // REQUIRES: commit() was not called.
  BufferedWriter& out() { return *out_; }
  const std::string& path() const { return path_; }

  // fsync, rename, fsync of the folder: after a power loss either the old file is there or the new.
  // THROWS: also Error{kBadInput} if the name was taken meanwhile and may not be replaced.
  void commit();

 private:
  void open_temporary();
  void open_device();
  void give_name();
  void copy_to_device();

  std::string path_;               // as the user wrote it
  std::string target_;             // where links lead to
  std::string temporary_;          // empty for devices, and once it has its name
  std::optional<File> collected_;  // the device that waits for all of out_
  AtomicOptions options_;
  std::optional<BufferedWriter> out_;
};

}  // namespace reeb::io
