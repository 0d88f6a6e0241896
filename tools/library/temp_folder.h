// A temporary folder of a run within a run.
#pragma once

#include <string>

namespace reeb {

// It is removed at the end with all that is in it.
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
};

}  // namespace reeb
