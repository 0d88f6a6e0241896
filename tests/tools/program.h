// The built program in its own folder, for tests that use it as a user does.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/files.h"
#include "tests/support/process.h"
#include "tests/support/run_limits.h"
#include "tests/support/scratch.h"

namespace reeb::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;  // memory figures are meaningless
#else
inline constexpr bool kSanitized = false;
#endif
#ifdef __SANITIZE_THREAD__
inline constexpr bool kThreadsSanitized = true;  // signals wait until a call of the system returns
#else
inline constexpr bool kThreadsSanitized = false;
#endif

class ProgramTest : public testing::Test {
 protected:
  // Runs `reeb WORDS...` in folder(), with its temporary files in another folder. The environment can limit runs of
  // compute (run_limits.h).
  Outcome reeb(std::vector<std::string> words, Command command = {}) {
    if (!words.empty() && words[0] == "compute") {
      if (const auto bytes = memory_limit()) words.insert(words.begin() + 1, {"--memory", std::to_string(*bytes)});
      if (const auto triangles = chunk_limit())
        words.insert(words.begin() + 1, {"--chunk", std::to_string(*triangles)});
    }
    command.arguments.assign(1, REEB_PROGRAM);
    command.arguments.insert(command.arguments.end(), words.begin(), words.end());
    command.folder = folder_.path();
    command.environment.emplace_back("TMPDIR", temp_.path());
    last_command_ = describe(command);
    return run_process(command);
  }

  const std::string& folder() const { return folder_.path(); }
  const std::string& temp_folder() const { return temp_.path(); }
  std::string in_folder(const std::string& name) const { return folder() + "/" + name; }
  std::string file(const std::string& name) const { return read_file(in_folder(name)); }
  void write(const std::string& name, const std::string& bytes) const { write_file(in_folder(name), bytes); }

  // The names in folder(), and the full paths of temporary files; sorted.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) names.push_back(entry.path().filename());
    for (const auto& entry : std::filesystem::directory_iterator(temp_folder())) names.push_back(entry.path());
    std::sort(names.begin(), names.end());
    return names;
  }

  void expect_success(const Outcome& outcome) const {
    EXPECT_EQ(outcome.exit_code, 0) << last_command_ << '\n' << outcome.error;
  }

  // Expects one error line that begins with `error_begin`, one hint, nothing on standard output, and this exit code.
  void expect_error(const Outcome& outcome, int exit_code, const std::string& error_begin = {}) const {
    SCOPED_TRACE(last_command_ + '\n' + outcome.error);
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_EQ(outcome.output, "");
    const auto errors = lines_after("reeb: error: ", outcome.error), hints = lines_after("hint: ", outcome.error);
    ASSERT_EQ(errors.size(), 1u);
    ASSERT_EQ(hints.size(), 1u);
    EXPECT_TRUE(errors[0].starts_with(error_begin)) << "instead of " << error_begin;
    EXPECT_GT(hints[0].size(), 3u);
    EXPECT_TRUE(outcome.error.ends_with("hint: " + hints[0] + "\n")) << "something follows the hint";
  }

  // A note or a warning in one line. Where it is wrapped depends on the paths in it.
  static std::string unwrapped(std::string text) {
    for (std::size_t at; (at = text.find("\n    ")) != std::string::npos;) text.replace(at, 5, " ");
    return text;
  }

  // The rest of each line that begins with `begin`.
  static std::vector<std::string> lines_after(const std::string& begin, const std::string& text) {
    std::vector<std::string> rests;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string line = text.substr(at, end - at);
      if (line.starts_with(begin)) rests.push_back(line.substr(begin.size()));
      at = end + 1;
    }
    return rests;
  }

  const std::string& last_command() const { return last_command_; }

 private:
  ooc::Scratch folder_, temp_;
  std::string last_command_;
};

// The surface of a tetrahedron.
inline constexpr const char* kSmallOff = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

}  // namespace reeb::test
