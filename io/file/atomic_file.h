// The way to write every output: a file gets its name only when it is whole.
//
// Bytes go to NAME.partial-PID-N in the same folder. commit() makes them durable and gives them their name in one step.
// Every other way out, exceptions included, removes them and leaves an older output untouched. A signal handler can
// remove them, too (temporary_name.h). If a process is killed, the next writer of the same output removes its partial
// file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/file/buffered_writer.h"
#include "io/file/temporary_name.h"

namespace reeb::io {

// What happens to a file that has the name of an output.
enum class Existing {
  kRefuse,   // the output is refused
  kReplace,  // it is replaced
  kKeep,     // it stays, and the output gets another name: for outputs whose name was free when the work began
};

// Checks before any work that an output can have this name.
// THROWS: as the constructor of AtomicFile.
void check_output_name(const std::string& path, Existing existing);

// The same for its place. THROWS: Error{kResource} if no file of this name can be created in its folder, which it
// names, or if `path` is a device that cannot be written. `how` says in the hint how to choose another folder.
void require_output_folder(const std::string& path, const char* how = "with -o FILE");

// The end of the chain of links that starts at `path`. There need not be a file yet.
// THROWS: Error{kBadInput} if the chain has no end.
std::string follow_links(const std::string& path);

// Whether `name` is that of a temporary file for the output `of`, both without a folder: NAME.partial-PID-N.
bool is_partial_name(std::string_view name, std::string_view of);

// Removes the temporary files that killed writers of `path` left. A living writer holds a lock on its file, which
// stays. AtomicFile calls this itself.
void remove_abandoned(const std::string& path);

struct AtomicOptions {
  Existing existing = Existing::kRefuse;
  // Whether the writer overwrites bytes that it appended. If so, the output for a device is first collected in a
  // temporary file.
  bool overwrites = false;
  std::string temp_folder = {};  // for that file; empty: TempDir::default_folder()
  std::size_t buffer_bytes = BufferedWriter::kBufferBytes;
};

// What is written depends on what `path` names now:
// - nothing, or a file: a new file. It gets the mode of the file that it replaces, or else 0666 minus the umask. While
//   it is being written, only this user may read it.
// - a symbolic link: the file that the link leads to, which is created if it is missing. The link stays.
// - a device, a FIFO or a socket: that itself. Bytes are written to it as they come; it is never replaced.
// The name "-" is standard output, which is written in the same way.
//
// THROWS, from every call: Error{kResource} with the path: the folder is missing or cannot be written, the disk is
// full.
class AtomicFile {
 public:
  // THROWS: Error{kBadInput} if `path` exists and may not be replaced, or is a link that leads only to itself;
  //         Error{kResource} if it may be replaced, but is a folder.
  explicit AtomicFile(const std::string& path, const AtomicOptions& options = {});
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // REQUIRES: commit() was not called.
  BufferedWriter& out() { return *out_; }
  const std::string& path() const { return path_; }
  // That of the file, as soon as it has one: at the end of the chain of links, or the other name that commit() gave it.
  // Also after commit() threw. Empty before, and for a device.
  const std::string& name() const { return name_; }

  // Calls fsync, rename, and fsync of the folder: after a power loss there is either the old file or the new one.
  // THROWS: also Error{kBadInput} if there is a file of this name now that may not be replaced. Then the new file is
  //         NAME.2 (or the next number that is free), as the error says.
  void commit();

 private:
  void open_temporary();
  void open_device();
  void give_name();
  [[noreturn]] void give_other_name();
  void copy_to_device();

  std::string path_;               // as the user wrote it
  std::string target_;             // where links lead to
  std::string name_;               // empty until commit()
  TemporaryName temporary_;        // empty for devices, and after it got its name
  std::optional<File> collected_;  // the device that gets out_ at the end
  AtomicOptions options_;
  std::optional<BufferedWriter> out_;
};

}  // namespace reeb::io
