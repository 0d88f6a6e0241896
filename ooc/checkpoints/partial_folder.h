// OUT.partial/: the files from which a later process can resume the run that writes OUT (docs/FORMAT.md, The partial
// folder).
#pragma once

#include <string>
#include <string_view>

namespace reeb::ooc {

// The folder next to `output`. It holds the checkpoint and the files that the checkpoint names, and belongs to one
// process at a time. Only this user has access to it. A mark shows that a run has created it. A folder that is not
// empty and has no mark, a folder that other users own or may write, and a symbolic link are refused and left
// unchanged.
//
// THROWS: Error{kResource} if the folder is refused, cannot be written, or another process is at work in it.
class PartialFolder {
 public:
  // Creates the folder if there is none.
  explicit PartialFolder(const std::string& output);
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;
  // Keeps the folder if there is a checkpoint in it.
  ~PartialFolder();

  static std::string path_for(const std::string& output) { return output + ".partial"; }
  // Whether a run to `output` left a checkpoint.
  static bool has_checkpoint(const std::string& output);

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  std::string checkpoint() const { return file("checkpoint"); }
  bool has_checkpoint() const noexcept;

  // Call this before the first checkpoint: it makes the folder's own name reach the device.
  void sync_name();

  // Removes the checkpoint and then, once that is durable, the other files with names that runs use. Anything else in
  // the folder stays.
  void clear() noexcept;

 private:
  void open();
  void claim();
  [[noreturn]] void refuse(const char* why) const;
  bool has_other_than(std::string_view name) const noexcept;

  std::string path_;
  int folder_ = -1;  // open and locked
  bool is_new_ = false;
  bool name_is_synced_ = false;
};

}  // namespace reeb::ooc
