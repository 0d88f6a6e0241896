// OUT.partial/: what a run on its way to OUT keeps for a later process to go on with
// (docs/FORMAT.md, The partial folder).
#pragma once

#include <string>
#include <vector>

namespace reeb::ooc {

// The folder beside `output`. It holds the checkpoint and the files that the checkpoint names, and
// belongs to one process at a time.
// Only this user may look into it. A mark says that a run has made it: a folder without the mark that is not empty, one
// of another user, or a symbolic link is refused and left as it is.
//
// THROWS: Error{kResource} if the folder is refused, cannot be written, or another process is at work in it.
class PartialFolder {
 public:
  // Makes the folder if there is none.
  explicit PartialFolder(const std::string& output);
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;
  // The folder stays if there is a checkpoint in it.
  ~PartialFolder();

  static std::string path_for(const std::string& output) { return output + ".partial"; }
  // Whether a run to `output` left a checkpoint.
  static bool has_checkpoint(const std::string& output);

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string checkpoint() const { return file("checkpoint"); }
  bool has_checkpoint() const;

  // To be called before the first checkpoint: the folder's own name reaches the device.
  void sync_name();

  // Removes the checkpoint and then, once that is durable, the other files that have a name as runs give it. What else
  // is in the folder stays.
  void clear() noexcept;

 private:
  void open();
  void claim();
  [[noreturn]] void refuse(const char* why) const;
  std::vector<std::string> entries() const;
  bool has_only_the_mark() const noexcept;

  std::string path_;
  int folder_ = -1;  // open and locked
  bool name_is_synced_ = false;
};

}  // namespace reeb::ooc
