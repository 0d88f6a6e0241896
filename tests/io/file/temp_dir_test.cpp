#include "io/file/temp_dir.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "io/file/input_file.h"
#include "libreeb/base/error.h"
#include "tests/support/scratch.h"

namespace reeb::ooc {
namespace {

std::span<const std::byte> text_bytes(const std::string& text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(TempDir, FilesHaveNoName) {
  const Scratch scratch;
  const io::TempDir temp(scratch.path());
  const io::File unnamed = temp.create_unnamed("pages");
  unnamed.write_at(0, text_bytes("abc"));
  unnamed.sync();
  EXPECT_TRUE(scratch.empty());
  std::array<char, 3> text{};
  unnamed.read_at(0, std::as_writable_bytes(std::span(text)));
  EXPECT_EQ(std::string(text.data(), 3), "abc");
  EXPECT_EQ(unnamed.size(), 3u);
}

TEST(TempDir, RefusesAFolderThatCannotBeWritten) {
  const Scratch scratch;
  const std::string plain = scratch.path() + "/file";
  std::ofstream(plain) << "x";
  for (const std::string& folder : {scratch.path() + "/missing", plain}) {
    try {
      io::TempDir temp(folder);
      ADD_FAILURE() << folder << " was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kResource);
      EXPECT_EQ(e.file(), folder);
      EXPECT_NE(e.hint().find("--temp-dir"), std::string::npos);
    }
  }
}

TEST(TempDir, TakesTheOutputsFolderUnlessTmpdirIsSet) {
  ::unsetenv("TMPDIR");
  EXPECT_EQ(io::TempDir::default_folder("/data/out/a.reeb"), "/data/out");
  EXPECT_EQ(io::TempDir::default_folder("a.reeb"), ".");
  ::setenv("TMPDIR", "/somewhere", 1);
  EXPECT_EQ(io::TempDir::default_folder("/data/out/a.reeb"), "/somewhere");
  ::unsetenv("TMPDIR");
}

TEST(File, ReportsAFullDiskWithPlaceAndNeed) {
  const Scratch scratch;
  const io::ScopedFileFaults faults(FaultAtCall(io::FileCall::kWrite, 2, {.error = ENOSPC}));
  const io::TempDir temp(scratch.path());
  const io::File file = temp.create_unnamed("arcs");
  file.write_at(0, text_bytes("abc"));
  try {
    file.write_at(4096, text_bytes("abcde"));
    FAIL() << "the error was swallowed";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kResource);
    EXPECT_EQ(e.position(), "4096");
    EXPECT_NE(e.file().find("arcs"), std::string::npos);
    EXPECT_NE(e.message().find("5 bytes"), std::string::npos);
    EXPECT_NE(e.hint().find("--temp-dir"), std::string::npos);
    // Not the size of the file: what it holds so far needs no more.
    EXPECT_NE(e.hint().find("at least 5 bytes"), std::string::npos) << e.hint();
  }
}

TEST(File, ReportsARealLimitOfTheSystem) {
  const Scratch scratch;
  io::TempDir temp(scratch.path());
  const io::File file = temp.create_unnamed("pages");
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 10'000;
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  const std::vector<std::byte> block(64 << 10);
  EXPECT_THROW(file.write_at(0, block), Error);  // a short write, then none
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old);
  EXPECT_EQ(file.size(), 10'000u);
}

TEST(File, RefusesToReadPastTheEnd) {
  const Scratch scratch;
  io::TempDir temp(scratch.path());
  const io::File file = temp.create_unnamed("pages");
  file.write_at(0, text_bytes("abc"));
  std::array<std::byte, 8> bytes{};
  EXPECT_THROW(file.read_at(0, bytes), Error);
  for (const std::string& missing : {scratch.path() + "/none", std::string()}) try {
      io::InputFile{missing};
      ADD_FAILURE() << "opened " << missing;
    } catch (const Error& error) {
      EXPECT_EQ(error.cause(), ErrorCause::kMissing);
    }
  try {
    io::File::open_for_reading(scratch.path() + "/none");
    FAIL() << "opened";
  } catch (const Error& error) {
    EXPECT_EQ(error.cause(), ErrorCause::kMissing);
  }
}

}  // namespace
}  // namespace reeb::ooc
