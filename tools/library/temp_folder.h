// A temporary folder of a run within a run.
#pragma once

#include <string>

namespace reeb {

// It is removed at the end with all that is in it. If the process was killed before, the next folder of the same
// parent removes it: a living owner holds a lock on its folder.
class TempFolder {
 public:
  // `parent`: "" is where temporary files are by default. THROWS: Error{kResource} if it cannot be created.
  explicit TempFolder(const std::string& parent);
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder();
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int lock_ = -1;  // the descriptor of the folder
};

}  // namespace reeb
