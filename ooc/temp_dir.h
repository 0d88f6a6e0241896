// Where temporary files live: out of sight, and gone on every way out (DESIGN.md 4).
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "ooc/file.h"

namespace reeb::ooc {

// A place for temporary files under `folder`. Most files have no name at all, so that nothing is
// left even if the process is killed. Files that must be found again by a later process get one,
// in a folder `reeb-XXXXXX` that appears with the first of them; the destructor removes it with
// all that is in it, unless keep() was called.
//
// THROWS: Error{kResource} naming --temp-dir if `folder` cannot be written.
// THREADS: any thread may create files.
class TempDir {
 public:
  // An empty `folder` means default_folder("").
  explicit TempDir(std::string folder = {}, WriteFault fault = {});
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  ~TempDir();

  // $TMPDIR if it is set, else the folder of `output_path` ("." for a bare name).
  static std::string default_folder(const std::string& output_path);

  // A file without a name, open for reading and writing; `role` ("segments") names it in messages.
  File create_unnamed(const std::string& role) const;
  // A file `name` in the folder reeb-XXXXXX.
  File create_named(const std::string& name);

  // Path of the folder reeb-XXXXXX, made if need be.
  const std::string& path();
  // Leaves the folder and its files in place, for a later process to go on with.
  void keep() { keep_ = true; }

  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
  std::shared_ptr<const WriteFault> fault_;
  std::mutex mutex_;   // guards path_
  std::string path_;  // empty until the first named file
  std::atomic<bool> keep_ = false;
};

}  // namespace reeb::ooc
