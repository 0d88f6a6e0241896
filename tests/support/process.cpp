#include "tests/support/process.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <system_error>

namespace reeb::test {
namespace {

// Exit code of a child that could not start the program, the same as in a shell.
constexpr int kNotStarted = 127;

// A nameless file for the output of the program. Unlike a pipe, it never makes the program wait.
class Capture {
 public:
  Capture() : file_(std::tmpfile()) {
    if (file_ == nullptr) throw std::system_error(errno, std::generic_category(), "tmpfile");
  }
  ~Capture() { std::fclose(file_); }
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  int descriptor() const { return ::fileno(file_); }
  std::string text() const {
    std::string text;
    std::rewind(file_);
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file_)) text.append(buffer, n);
    return text;
  }

 private:
  std::FILE* file_;
};

[[noreturn]] void become(const Command& command, int output, int error) {
  const int input = ::open(command.input.c_str(), O_RDONLY | O_CLOEXEC);
  bool good = input >= 0 && ::dup2(input, STDIN_FILENO) >= 0 && ::dup2(output, STDOUT_FILENO) >= 0 &&
              ::dup2(error, STDERR_FILENO) >= 0;
  if (!command.folder.empty()) good = good && ::chdir(command.folder.c_str()) == 0;
  for (const auto& [name, value] : command.environment) ::setenv(name.c_str(), value.c_str(), 1);
  if (command.address_space_bytes != 0) {
    const rlimit limit{command.address_space_bytes, command.address_space_bytes};
    good = good && ::setrlimit(RLIMIT_AS, &limit) == 0;
  }
  ::alarm(command.most_seconds);
  std::vector<char*> arguments;
  for (const auto* words : {&command.wrapper, &command.arguments})
    for (const std::string& word : *words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  if (good) ::execvp(arguments[0], arguments.data());
  std::perror(arguments[0]);
  ::_exit(kNotStarted);
}

}  // namespace

Outcome run_process(const Command& command) {
  const Capture output, error;
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) become(command, output.descriptor(), error.descriptor());
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, 0, &usage) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "wait4");
  Outcome outcome;
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  outcome.output = output.text();
  outcome.error = error.text();
  outcome.peak_rss_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
  return outcome;
}

std::string describe(const Command& command) {
  std::string text;
  for (const std::string& argument : command.arguments) text += (text.empty() ? "" : " ") + argument;
  if (command.input != "/dev/null") text += " < " + command.input;
  return text;
}

}  // namespace reeb::test
