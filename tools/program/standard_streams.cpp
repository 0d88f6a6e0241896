#include "tools/program/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>

#include "io/file/file.h"
#include "libreeb/base/error.h"

namespace reeb::tools {
namespace {

// Writes what it can, and reports all as written.
ssize_t write_or_drop(void* /*cookie*/, const char* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t got = ::write(STDERR_FILENO, bytes + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    done += static_cast<std::size_t>(got);
  }
  return static_cast<ssize_t>(count);
}

}  // namespace

void protect_standard_streams() {
  // open() returns the lowest free number. Reading from a stream that is open for writing only is an error, and the
  // other way round.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)!::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  // fmt throws where stdio fails, so stdio may not fail. A line is one write.
  if (std::FILE* messages = ::fopencookie(nullptr, "w", {nullptr, write_or_drop, nullptr, nullptr})) {
    std::setvbuf(messages, nullptr, _IOLBF, BUFSIZ);
    stderr = messages;
  }
}

void finish_standard_output() {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  const int error = errno;
  end_if_nobody_reads();
  // Not all commands that print could write to a file instead.
  throw Error(ErrorKind::kResource,
              std::string("cannot be written") + (error == 0 ? "" : std::string(": ") + std::strerror(error)),
              io::hint_for(error, "check what standard output leads to"))
      .at(io::kStandardOutputShown);
}

void end_if_nobody_reads() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  if (::poll(&output, 1, 0) != 1 || (output.revents & POLLERR) == 0) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

}  // namespace reeb::tools
