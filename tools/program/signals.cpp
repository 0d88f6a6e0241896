#include "tools/program/signals.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <memory>
#include <string_view>

#include "io/file/temporary_name.h"
#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

std::atomic<bool> watched = false, interrupted = false, ending = false, silent = false, on_terminal = false;
std::atomic<pid_t> companion = 0;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<pid_t>::is_always_lock_free,
              "a signal handler may do nothing else");

// Does only what a signal handler may do.
void end_now() {
  if (ending.exchange(true)) return;  // another thread is at it
  io::remove_temporary_names();
  if (const pid_t child = companion) ::kill(child, SIGKILL);
  constexpr std::string_view kClearLine = "\r\033[K";
  const std::string_view text = watched ? "reeb: error: interrupted at once\nhint: run it again; with --resume, it "
                                          "continues from the last checkpoint, if there is one\n"
                                        : "reeb: error: interrupted\nhint: run it again\n";
  if (on_terminal) (void)!::write(STDERR_FILENO, kClearLine.data(), kClearLine.size());
  if (!silent) (void)!::write(STDERR_FILENO, text.data(), text.size());
  ::_exit(static_cast<int>(ErrorKind::kInterrupted));
}

void on_interruption(int) {
  if (watched && !interrupted.exchange(true)) return;
  end_now();
}

}  // namespace

void handle_signals(bool speaks) {
  silent = !speaks;
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  on_terminal = ::isatty(STDERR_FILENO) == 1;
  struct sigaction action {
  }, before{};
  action.sa_handler = on_interruption;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    ::sigaction(signal, &action, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

std::function<bool()> watch_signals() {
  struct Watch {
    ~Watch() { watched = interrupted = false; }
  };
  return [watch = std::make_shared<Watch>()] {
    watched = true;
    return interrupted.load();
  };
}

void end_together_with(pid_t child) { companion = child; }

}  // namespace reeb::tools
