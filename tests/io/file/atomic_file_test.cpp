#include "io/file/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <optional>

#include "io/file/file_ostream.h"
#include "libreeb/base/error.h"
#include "tests/support/scratch.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;
using ooc::Scratch;

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::size_t entries(const Scratch& scratch) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(scratch.path()), {}));
}

unsigned mode(const std::string& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 0777;
}

void write(const std::string& path, const std::string& text, const AtomicOptions& options = {}) {
  AtomicFile file(path, options);
  file.out().append(text);
  file.commit();
}

std::optional<Error> error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(AtomicFile, AppearsWhenItIsWholeAndOnlyThen) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a";
  {
    AtomicFile file(path);
    file.out().append("abandoned");
    file.out().flush();
    EXPECT_FALSE(fs::exists(path));
    EXPECT_EQ(entries(scratch), 1u);
    for (const auto& entry : fs::directory_iterator(scratch.path())) EXPECT_EQ(mode(entry.path().string()), 0600u);
  }
  EXPECT_TRUE(scratch.empty());
  const std::string text(3'000'000, 'x');
  write(path, text);
  EXPECT_EQ(content(path), text);
  EXPECT_EQ(entries(scratch), 1u);
}

TEST(AtomicFile, AnExistingFileIsReplacedOnlyOnRequest) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a";
  put(path, "old");
  const auto early = error_of([&] { AtomicFile file(path); });
  EXPECT_EQ(early->kind(), ErrorKind::kBadInput);
  // A file that is created while the output is written.
  fs::remove(path);
  std::string late_name;
  const auto late = error_of([&] {
    AtomicFile file(path);
    file.out().append("new");
    put(path, "old");
    EXPECT_EQ(file.name(), "");
    try {
      file.commit();
    } catch (...) {
      late_name = file.name();
      throw;
    }
  });
  EXPECT_EQ(early->message(), "the output exists already");
  EXPECT_EQ(early->cause(), ErrorCause::kExists);
  EXPECT_EQ(late->kind(), ErrorKind::kBadInput);
  EXPECT_NE(late->message().find(path + ".2"), std::string::npos) << late->message();
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(content(path + ".2"), "new") << "the result is kept";
  EXPECT_EQ(late_name, path + ".2");
  EXPECT_THROW(write(path, "newer", {.existing = Existing::kKeep}), Error);
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(content(path + ".3"), "newer");
  EXPECT_EQ(entries(scratch), 3u);
  write(path, "new", {.existing = Existing::kReplace});
  EXPECT_EQ(content(path), "new");
}

// Simulates a file system that does not support RENAME_NOREPLACE.
TEST(AtomicFile, RefusesWithoutHelpOfTheFileSystem) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a";
  const ScopedFileFaults faults(
      ooc::FaultAtCall(FileCall::kRename, 1, {.error = EINVAL}, ooc::FaultAtCall::Which::kAllFrom));
  write(path, "first");
  EXPECT_EQ(content(path), "first");
  EXPECT_EQ(entries(scratch), 1u);
  fs::rename(path, scratch.path() + "/b");
  const auto late = error_of([&] {
    AtomicFile file(path);
    put(path, "old");
    file.commit();
  });
  EXPECT_NE(late->message().find(path + ".2"), std::string::npos) << late->message();
  EXPECT_EQ(content(path), "old");
  EXPECT_EQ(entries(scratch), 3u);
}

TEST(AtomicFile, HasTheUsualModeOrThatOfTheFileItReplaces) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a";
  for (const mode_t mask : {022u, 077u, 002u}) {
    const mode_t before = ::umask(mask);
    write(path, "x");
    ::umask(before);
    EXPECT_EQ(mode(path), 0666u & ~mask);
    fs::remove(path);
  }
  put(path, "old");
  ::chmod(path.c_str(), 0640);
  write(path, "new", {.existing = Existing::kReplace});
  EXPECT_EQ(mode(path), 0640u);
}

TEST(AtomicFile, FollowsLinksAndLeavesThem) {
  const Scratch scratch;
  const std::string link = scratch.path() + "/link";
  fs::create_directory(scratch.path() + "/folder");
  fs::create_symlink("folder/target", link);
  fs::create_symlink(link, scratch.path() + "/link2");
  write(scratch.path() + "/link2", "made");  // a dangling link
  EXPECT_EQ(content(scratch.path() + "/folder/target"), "made");
  EXPECT_EQ(error_of([&] { write(link, "again"); })->message(), "the output exists already");
  write(link, "replaced", {.existing = Existing::kReplace});
  EXPECT_EQ(content(scratch.path() + "/folder/target"), "replaced");
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path() + "/folder"), {}), 1);

  const std::string loop = scratch.path() + "/loop";
  fs::create_symlink("loop", loop);
  const auto looping = error_of([&] { write(loop, "x", {.existing = Existing::kReplace}); });
  EXPECT_EQ(looping->kind(), ErrorKind::kBadInput);
  EXPECT_TRUE(fs::is_symlink(loop));
  fs::create_symlink(scratch.path() + "/none/target", scratch.path() + "/nowhere");
  EXPECT_EQ(error_of([&] { write(scratch.path() + "/nowhere", "x"); })->kind(), ErrorKind::kResource);
}

TEST(AtomicFile, WritesIntoADeviceAndLeavesItThere) {
  const Scratch scratch;
  const std::string link = scratch.path() + "/null", full = scratch.path() + "/full", fifo = scratch.path() + "/fifo";
  fs::create_symlink("/dev/null", link);
  fs::create_symlink("/dev/full", full);
  write(link, "x");
  for (const bool overwrites : {false, true})
    EXPECT_EQ(error_of([&] { write(full, "x", {.overwrites = overwrites}); })->kind(), ErrorKind::kResource);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  for (const bool overwrites : {false, true}) {
    auto reader = std::async(std::launch::async, [&] { return content(fifo); });
    AtomicFile file(fifo, {.overwrites = overwrites});
    file.out().append("abcdef");
    if (overwrites) file.out().overwrite(1, "XY");
    file.commit();
    EXPECT_EQ(reader.get(), overwrites ? "aXYdef" : "abcdef");
  }
  EXPECT_TRUE(fs::is_fifo(fifo));
  EXPECT_EQ(entries(scratch), 3u);
}

TEST(AtomicFile, AFolderIsNoOutput) {
  const Scratch scratch;
  EXPECT_EQ(error_of([&] { write(scratch.path(), "x"); })->kind(), ErrorKind::kBadInput) << "it exists";
  EXPECT_EQ(error_of([&] { write(scratch.path(), "x", {.existing = Existing::kReplace}); })->kind(),
            ErrorKind::kResource);
  EXPECT_EQ(error_of([&] { write(scratch.path() + "/none/a", "x"); })->kind(), ErrorKind::kResource);
  EXPECT_TRUE(scratch.empty());
}

TEST(AtomicFile, RemovesWhatKilledWritersLeft) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a";
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(path);
    file.out().append("never whole");
    file.out().flush();
    ::raise(SIGKILL);
  }
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(entries(scratch), 1u);
  put(path + ".partial-notes", "mine");
  {
    AtomicFile living(path);  // the next writer must leave its file alone
    write(path, "whole");
    EXPECT_EQ(entries(scratch), 3u);
  }
  EXPECT_EQ(entries(scratch), 2u);
  EXPECT_EQ(content(path), "whole");
}

TEST(BufferedWriter, AppendsOverwritesAndJoins) {
  const Scratch scratch;
  const TempDir temp(scratch.path());
  const std::string path = scratch.path() + "/a";
  std::string expected;
  {
    AtomicFile file(path, {.buffer_bytes = 100});
    BufferedWriter tail(temp.create_unnamed("tail"), 64);
    for (int i = 0; i < 300; ++i) {
      const std::string piece(static_cast<std::size_t>(i), static_cast<char>('a' + i % 26));
      file.out().append(piece);
      expected += piece;
      tail.append("tail " + std::to_string(i));
    }
    for (int i = 0; i < 300; ++i) expected += "tail " + std::to_string(i);
    char* const record = file.out().reserve_record(50);
    std::fill_n(record, 50, '#');
    file.out().commit_record(3);
    expected.insert(300 * 299 / 2, "###");
    file.out().overwrite(10, "0123456789");
    expected.replace(10, 10, "0123456789");
    EXPECT_EQ(file.out().size(), 300u * 299 / 2 + 3);
    file.out().append_file(tail);
    FileOstream stream(file.out());
    stream << "end";
    const auto end = stream.tellp();
    stream.seekp(0);
    stream << "begin";
    stream.seekp(end);
    stream << "!";
    file.commit();
  }
  expected.replace(0, 5, "begin");
  EXPECT_EQ(content(path), expected + "end!");
}

}  // namespace
}  // namespace reeb::io
