// An output file that appears under its name only when it is whole.
//
// The bytes go to NAME.tmp-PID in the same folder; commit() makes them durable and gives them
// their name in one step. Every other way out, exceptions included, removes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "io/file/output_file.h"

namespace reeb::io {

enum class Existing { kRefuse, kReplace };

class AtomicOutputFile {
 public:
  // A path that names a device or a pipe is written to directly, since there is nothing to replace;
  // a symbolic link is followed.
  // THROWS: Error{kBadInput} if `path` exists and may not be replaced, or is a folder;
  //         Error{kResource} if the folder is missing or cannot be written.
  explicit AtomicOutputFile(const std::string& path, Existing existing = Existing::kRefuse);
  AtomicOutputFile(const AtomicOutputFile&) = delete;
  AtomicOutputFile& operator=(const AtomicOutputFile&) = delete;
  ~AtomicOutputFile();

  // REQUIRES: commit() was not called.
  OutputFile& out() { return *out_; }
  const std::string& path() const { return path_; }

  // THROWS: Error{kResource} as any write; Error{kBadInput} if the name was taken meanwhile.
  void commit();

 private:
  void give_name();

  std::string path_, temporary_;  // temporary_ is empty for devices, and once it has its name
  Existing existing_;
  std::optional<OutputFile> out_;
};

// Says before any work that an output cannot have this name.
// THROWS: Error{kBadInput} as the constructor of AtomicOutputFile.
void check_output_name(const std::string& path, Existing existing);

}  // namespace reeb::io
