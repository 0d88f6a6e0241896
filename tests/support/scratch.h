// For the tests of ooc: a folder that must be empty in the end, and writes that fail.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "io/file/fault.h"
#include "io/file/file.h"
#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/memory_budget.h"

namespace reeb::ooc {

// A fresh folder of its own, removed by the destructor.
class Scratch {
 public:
  Scratch() : path_((std::filesystem::temp_directory_path() / "ooc-test-XXXXXX").string()) {
    if (::mkdtemp(path_.data()) == nullptr) std::abort();
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() { std::filesystem::remove_all(path_); }

  const std::string& path() const { return path_; }
  bool empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::string path_;
};

// Counts the calls of one kind, from 1. The fault is in call n and all later ones, as on a full disk, or in call n
// only. n = 0: no fault.
class FaultAtCall {
 public:
  enum class Which { kOne, kAllFrom };
  explicit FaultAtCall(io::FileCall call, std::uint64_t n = 0, io::FileFault fault = {}, Which which = Which::kAllFrom)
      : call_(call), n_(n), fault_(fault), which_(which) {}

  io::FileFault operator()(io::FileCall call) const {
    if (call != call_) return {};
    const std::uint64_t number = ++*count_;
    const bool now = n_ != 0 && (which_ == Which::kOne ? number == n_ : number >= n_);
    return now ? fault_ : io::FileFault{};
  }
  std::uint64_t count() const { return *count_; }

 private:
  io::FileCall call_;
  std::uint64_t n_;
  io::FileFault fault_;
  Which which_;
  std::shared_ptr<std::atomic<std::uint64_t>> count_ = std::make_shared<std::atomic<std::uint64_t>>(0);
};

// Runs `run(temp, budget)` once with a good disk, then with disks that are full starting at the n-th write, for n
// spread over all writes. Each failure must arrive as an Error that names a file, and leave no memory reserved and no
// file in the folder.
template <class Run>
void expect_failing_writes_are_reported(const Run& run) {
  const Scratch scratch;
  const FaultAtCall writes(io::FileCall::kWrite);
  {
    const io::ScopedFileFaults faults(writes);
    MemoryBudget budget;
    run(io::TempDir(scratch.path()), budget);
  }
  ASSERT_GT(writes.count(), 3u) << "nothing spills any more";
  for (std::uint64_t n = 1; n <= writes.count(); n += 1 + n / 8) {
    MemoryBudget budget;
    try {
      const io::ScopedFileFaults faults(FaultAtCall(io::FileCall::kWrite, n, {.error = ENOSPC}));
      run(io::TempDir(scratch.path()), budget);
      ADD_FAILURE() << "write " << n << ": the error was swallowed";
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::kResource);
      EXPECT_NE(e.file(), "");
    }
    EXPECT_EQ(budget.used_bytes(), 0u);
    EXPECT_TRUE(scratch.empty());
  }
}

}  // namespace reeb::ooc
