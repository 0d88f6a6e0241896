// Every system call of the file layer fails once: the failure arrives as an Error that names a file, and leaves nothing
// in the folder. A short or interrupted call is continued.
#include "io/file/fault.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>

#include "io/file/atomic_file.h"
#include "io/file/content_source.h"
#include "io/file/file_windows.h"
#include "libreeb/base/error.h"
#include "tests/support/scratch.h"

namespace reeb::io {
namespace {

namespace fs = std::filesystem;
using ooc::FaultAtCall;
using ooc::Scratch;
using Which = FaultAtCall::Which;

constexpr FileCall kCalls[] = {FileCall::kOpen, FileCall::kRead, FileCall::kWrite, FileCall::kSync, FileCall::kRename};

std::string pattern(std::size_t bytes) {
  std::string text(bytes, ' ');
  for (std::size_t i = 0; i < bytes; ++i) text[i] = static_cast<char>(i * 31 + i / 251);
  return text;
}

std::string content(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Uses the whole layer: writes an output, part of which waits in a temporary file, and reads it back in both ways.
void use_files(const std::string& folder, Existing existing) {
  const std::string path = folder + "/out", expected = pattern(300'000);
  const TempDir temp(folder);
  {
    BufferedWriter waiting(temp.create_unnamed("waiting"), 10'000);
    AtomicFile file(path, {.existing = existing, .overwrites = true, .buffer_bytes = 5'000});
    file.out().append(std::string_view(expected).substr(0, 100'000));
    waiting.append(std::string_view(expected).substr(100'000));
    file.out().append_file(waiting);
    file.out().overwrite(0, std::string_view(expected).substr(0, 50));
    file.commit();
  }
  const File in = File::open_for_reading(path);
  std::string back(static_cast<std::size_t>(in.size()), ' ');
  in.read_at(0, std::as_writable_bytes(std::span(back)));
  EXPECT_TRUE(back == expected);
  FileWindows windows(path, {.window_bits = 16, .window_count = 2, .overlap_bytes = 4096});
  for (std::uint64_t at = 0; at < windows.size(); at += 1000) ASSERT_EQ(*windows.at(at), expected[at]);
}

class Faults : public testing::TestWithParam<Existing> {};

TEST_P(Faults, EachIsReportedAndLeavesNothing) {
  for (const FileCall call : kCalls) {
    const Scratch scratch;
    const FaultAtCall counter(call);
    {
      const ScopedFileFaults faults(counter);
      use_files(scratch.path(), GetParam());
    }
    fs::remove(scratch.path() + "/out");
    ASSERT_GT(counter.count(), 0u) << "call " << static_cast<int>(call) << " is not made any more";
    for (std::uint64_t n = 1; n <= counter.count(); ++n) {
      if (GetParam() == Existing::kReplace) std::ofstream(scratch.path() + "/out") << "old";
      const ScopedFileFaults faults(FaultAtCall(call, n, {.error = EIO}, Which::kOne));
      try {
        use_files(scratch.path(), GetParam());
        ADD_FAILURE() << "call " << static_cast<int>(call) << ", " << n << ": the error was swallowed";
      } catch (const Error& error) {
        EXPECT_TRUE(error.file().starts_with(scratch.path())) << error.what();
        EXPECT_FALSE(error.hint().empty());
      }
      // The output is complete, or the old one is unchanged.
      const std::string left = content(scratch.path() + "/out");
      EXPECT_TRUE(left == pattern(300'000) || left == (GetParam() == Existing::kReplace ? "old" : ""));
      fs::remove(scratch.path() + "/out");
      EXPECT_TRUE(scratch.empty()) << "call " << static_cast<int>(call) << ", " << n;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Existing, Faults, testing::Values(Existing::kRefuse, Existing::kReplace));

// After a power failure there is the old output or the whole new one: the content is on the device before it has the
// name, and the name before commit() returns.
TEST(Fault, AnOutputIsOnTheDeviceBeforeItHasItsName) {
  for (const Existing existing : {Existing::kRefuse, Existing::kReplace}) {
    const Scratch scratch;
    std::string calls;
    AtomicFile file(scratch.path() + "/out", {.existing = existing});
    file.out().append(pattern(1000));
    const ScopedFileFaults faults([&calls](FileCall call) {
      if (call == FileCall::kWrite) calls += 'w';
      if (call == FileCall::kSync) calls += 's';
      if (call == FileCall::kRename) calls += 'r';
      return FileFault{};
    });
    file.commit();
    EXPECT_EQ(calls, "wsrs");
  }
}

TEST(Fault, AWriteThatTakesNothingIsAFullDisk) {
  const Scratch scratch;
  const ScopedFileFaults faults(FaultAtCall(FileCall::kWrite, 1, {.most_bytes = 0}));
  EXPECT_THROW(use_files(scratch.path(), Existing::kRefuse), Error);
  EXPECT_TRUE(scratch.empty());
}

TEST(Fault, WhatIsInterruptedIsCalledAgain) {
  const Scratch scratch;
  std::uint64_t calls = 0;
  // Every call is interrupted twice before it is made.
  const ScopedFileFaults faults(
      [&calls](FileCall) { return ++calls % 3 != 0 ? FileFault{.error = EINTR} : FileFault{}; });
  ASSERT_NO_THROW(use_files(scratch.path(), Existing::kRefuse));
  EXPECT_GT(calls, 60u);
}

TEST(Fault, WhatIsShortGoesOn) {
  const Scratch scratch;
  std::uint64_t calls = 0;
  const ScopedFileFaults faults([&calls](FileCall) { return FileFault{.most_bytes = 1 + ++calls % 777}; });
  ASSERT_NO_THROW(use_files(scratch.path(), Existing::kRefuse));
  EXPECT_GT(calls, 1000u);
}

TEST(Fault, AFullDiskIsSaidInTheWordsOfTheSystem) {
  const Scratch scratch;
  const ScopedFileFaults faults(FaultAtCall(FileCall::kWrite, 3, {.error = ENOSPC}));
  try {
    use_files(scratch.path(), Existing::kRefuse);
    FAIL() << "the error was swallowed";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kResource);
    EXPECT_NE(error.message().find("No space left"), std::string::npos);
    EXPECT_NE(error.hint().find("make room"), std::string::npos);
  }
}

// A pipe that holds these bytes, as a path.
class FullPipe {
 public:
  explicit FullPipe(const std::string& bytes) {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe(ends.data()), 0);
    EXPECT_EQ(::write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    ::close(ends[1]);
    descriptor_ = ends[0];
  }
  FullPipe(const FullPipe&) = delete;
  FullPipe& operator=(const FullPipe&) = delete;
  ~FullPipe() { ::close(descriptor_); }
  std::string path() const { return "/dev/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_ = -1;
};

std::string read_content(const std::string& path) {
  const auto source = open_content(path);
  std::string bytes;
  for (std::string_view view; !(view = source->view(bytes.size(), 1)).empty();) bytes += view;
  return bytes;
}

TEST(Fault, APipeThatIsInterruptedIsReadWhole) {
  const std::string bytes = pattern(60'000);
  const FullPipe pipe(bytes);
  std::uint64_t calls = 0;
  const ScopedFileFaults faults([&calls](FileCall) {
    return ++calls % 3 == 0 ? FileFault{.most_bytes = 1 + calls % 777} : FileFault{.error = EINTR};
  });
  EXPECT_TRUE(read_content(pipe.path()) == bytes);
  EXPECT_GT(calls, 300u);
}

TEST(Fault, APipeThatCannotBeReadIsABadInput) {
  for (const FileCall call : {FileCall::kOpen, FileCall::kRead}) {
    const FullPipe pipe("abc");
    const ScopedFileFaults faults(FaultAtCall(call, 1, {.error = EIO}));
    try {
      read_content(pipe.path());
      ADD_FAILURE() << "the error was swallowed";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      EXPECT_EQ(error.file(), pipe.path());
      EXPECT_NE(error.message().find("cannot be read: "), std::string::npos) << error.what();
    }
  }
}

TEST(File, CreateReplacesFilesOnly) {
  const Scratch scratch;
  const std::string path = scratch.path() + "/a", link = scratch.path() + "/link";
  std::ofstream(path) << "old";
  EXPECT_EQ(File::create(path).size(), 0u);
  fs::create_symlink(path, link);
  std::ofstream(path) << "mine";
  EXPECT_THROW(File::create(link), Error);
  EXPECT_EQ(content(path), "mine");
  fs::remove(link);
  ASSERT_EQ(::mkfifo(link.c_str(), 0600), 0);
  EXPECT_THROW(File::create(link), Error);
  EXPECT_TRUE(fs::is_fifo(link));
}

TEST(File, AnInputThatEndsEarlyIsABadInput) {
  const Scratch scratch;
  std::ofstream(scratch.path() + "/a") << "abc";
  const File file = File::open_for_reading(scratch.path() + "/a");
  std::array<std::byte, 8> bytes{};
  try {
    file.read_at(1, bytes);
    FAIL() << "read past the end";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_EQ(error.position(), "3");
  }
  for (const std::string& path : {scratch.path(), std::string("/dev/null"), scratch.path() + "/none"})
    EXPECT_THROW(File::open_for_reading(path), Error) << path;
}

}  // namespace
}  // namespace reeb::io
