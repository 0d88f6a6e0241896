#include "tests/fuzz/crash_report.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <string_view>

// Exists under sanitizers only.
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace reeb::test {
namespace {

const std::string* current = nullptr;
std::string file_name;

void say(std::string_view text) { [[maybe_unused]] const auto done = ::write(STDERR_FILENO, text.data(), text.size()); }

// Neither allocates nor locks: it is called from signal handlers.
void keep_input() {
  const std::string* const input = current;
  if (input == nullptr) return;
  current = nullptr;
  const int file = ::open(file_name.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) return say("\nthe input cannot be kept\n");
  for (std::size_t at = 0; at < input->size();) {
    const ssize_t done = ::write(file, input->data() + at, input->size() - at);
    if (done <= 0) break;
    at += static_cast<std::size_t>(done);
  }
  ::close(file);
  say("\nthe input is kept as ");
  say(file_name);
  say("; REEB_FUZZ_INPUT=");
  say(file_name);
  say(" runs it again\n");
}

void on_signal(int signal) {
  if (signal == SIGALRM) say("\nan input takes too long\n");
  keep_input();
  std::signal(signal == SIGALRM ? SIGABRT : signal, SIG_DFL);
  std::raise(signal == SIGALRM ? SIGABRT : signal);
}

void install() {
  std::signal(SIGABRT, on_signal);
  std::signal(SIGALRM, on_signal);
  if (__sanitizer_set_death_callback != nullptr)
    __sanitizer_set_death_callback(keep_input);
  else
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) std::signal(signal, on_signal);
}

}  // namespace

void watch_input(const std::string* bytes, const std::string& target) {
  static const bool installed = (install(), true);
  (void)installed;
  if (file_name.find(target) == std::string::npos)
    file_name =
        std::filesystem::temp_directory_path() / ("reeb-fuzz-" + target + "-" + std::to_string(::getpid()) + ".input");
  current = bytes;
  ::alarm(bytes == nullptr ? 0 : kMaxSecondsPerInput);
}

}  // namespace reeb::test
