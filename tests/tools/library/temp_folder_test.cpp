// The named folders of runs within a run: none is left, not even by a process that was killed.
#include "tools/library/temp_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/support/files.h"
#include "tests/support/scratch.h"

namespace reeb::test {
namespace {

namespace fs = std::filesystem;

TEST(TempFolder, IsRemovedWithWhatIsInIt) {
  const ooc::Scratch parent;
  {
    const TempFolder folder(parent.path());
    write_file(folder.path() + "/graph.reeb", "some bytes");
    EXPECT_FALSE(fs::is_empty(parent.path()));
  }
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

TEST(TempFolder, RemovesThatOfAProcessThatWasKilled) {
  const ooc::Scratch parent;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const TempFolder folder(parent.path());
    write_file(folder.path() + "/graph.reeb", "some bytes");
    ::_exit(0);  // without destructors
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_FALSE(fs::is_empty(parent.path()));
  { const TempFolder folder(parent.path()); }
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

TEST(TempFolder, LeavesAllOthers) {
  const ooc::Scratch parent;
  const TempFolder living(parent.path());
  const std::string other_name = parent.path() + "/reeb-again-results", file = parent.path() + "/reeb-again-abcdef",
                    of_the_user = parent.path() + "/reeb-again-backup";
  fs::create_directory(other_name);
  fs::create_directory(of_the_user);
  write_file(of_the_user + "/thesis.txt", "much work");
  write_file(file, "no folder");
  fs::create_directory_symlink(other_name, parent.path() + "/reeb-again-ghijkl");
  { const TempFolder folder(parent.path()); }
  EXPECT_TRUE(fs::is_directory(living.path()));
  EXPECT_TRUE(fs::is_directory(other_name));
  EXPECT_TRUE(fs::is_regular_file(of_the_user + "/thesis.txt"));
  EXPECT_TRUE(fs::is_regular_file(file));
  EXPECT_TRUE(fs::is_symlink(parent.path() + "/reeb-again-ghijkl"));
}

}  // namespace
}  // namespace reeb::test
