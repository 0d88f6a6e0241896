// Where temporary files are: without a name, and gone on every way out.
#pragma once

#include <string>

#include "io/file/file.h"

namespace reeb::io {

// Creates temporary files in `folder`. They have no name, so nothing is left even if the process is killed.
//
// THROWS: Error{kResource} naming --temp-dir if `folder` cannot be written.
// THREADS: any thread may create files.
class TempDir {
 public:
  // An empty `folder` means default_folder("").
  explicit TempDir(std::string folder = {});
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;

  // $TMPDIR if it is set, else the folder of `output_path` ("." for a bare name, /tmp for a device). Without an output:
  // ".", or /tmp if nothing can be written there.
  static std::string default_folder(const std::string& output_path);

  // A file without a name, open for reading and writing; `role` ("segments") names it in messages.
  File create_unnamed(const std::string& role) const;

  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

}  // namespace reeb::io
