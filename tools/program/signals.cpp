#include "tools/program/signals.h"

#include <spawn.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstddef>
#include <memory>
#include <string_view>

#include "io/file/temporary_name.h"
#include "libreeb/base/error.h"

extern char** environ;

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

StartedChild start_child(const Child& child) {
  std::vector<std::string> words = child.arguments;
  words.insert(words.begin(), child.program);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int stream = 0; stream < 3; ++stream)
    posix_spawn_file_actions_adddup2(&actions, child.streams[static_cast<std::size_t>(stream)], stream);
  // This process ignores some signals, which a child would inherit.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGCHLD}) sigaddset(&usual, signal);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  // A signal between the start and the end of this function would leave the child alone.
  sigset_t ends, before;
  sigemptyset(&ends);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&ends, signal);
  ::pthread_sigmask(SIG_BLOCK, &ends, &before);
  posix_spawnattr_setsigmask(&attributes, &before);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int flags = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | (child.is_apart ? POSIX_SPAWN_SETPGROUP : 0);
  posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
  StartedChild started;
  started.error =
      ::posix_spawnp(&started.process, child.program.c_str(), &actions, &attributes, pointers.data(), environ);
  if (started.error == 0 && !child.is_apart) companion = started.process;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return started;
}

void forget_child() { companion = 0; }

}  // namespace reeb::tools
