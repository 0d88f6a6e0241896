#include "tests/tools/commands_in_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <new>
#include <system_error>

#include "libreeb/base/error.h"
#include "tests/support/allocation_pause.h"
#include "tools/commands/commands.h"
#include "tools/runs/fragment_commands.h"

namespace reeb::test {
namespace {

using AddCommand = void (*)(tools::Program&);
// All but `view`, which serves until a signal ends the process.
const std::map<std::string, AddCommand> kCommands = {
    {"compute", tools::add_compute}, {"info", tools::add_info},         {"extract", tools::add_extract},
    {"pairs", tools::add_pairs},     {"verify", tools::add_verify},     {"generate", tools::add_generate},
    {"convert", tools::add_convert}, {"function", tools::add_function}, {"plot", tools::add_plot},
    {"defects", tools::add_defects}, {"repair", tools::add_repair},     {"segment", tools::add_segment},
    {"report", tools::add_report},   {"fragment", tools::add_fragment}, {"glue", tools::add_glue},
};

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

// Replaces a standard stream during its lifetime.
class Redirected {
 public:
  Redirected(int stream, int to) : stream_(stream), saved_(checked(::fcntl(stream, F_DUPFD_CLOEXEC, 10), "fcntl")) {
    checked(::dup2(to, stream), "dup2");
    ::close(to);
  }
  Redirected(const Redirected&) = delete;
  Redirected& operator=(const Redirected&) = delete;
  ~Redirected() {
    ::dup2(saved_, stream_);
    ::close(saved_);
  }

 private:
  int stream_, saved_;
};

int opened(const std::string& path, int flags) { return checked(::open(path.c_str(), flags | O_CLOEXEC), "open"); }

void flush_standard_streams() {
  std::cout.flush();
  std::fflush(stdout);
  std::fflush(stderr);
}

std::string content_of(int descriptor) {
  std::string text(static_cast<std::size_t>(::lseek(descriptor, 0, SEEK_END)), ' ');
  checked(static_cast<int>(::pread(descriptor, text.data(), text.size(), 0)), "pread");
  return text;
}

}  // namespace

CommandOutcome run_command(const std::vector<std::string>& words, const std::string& input,
                           const std::function<void(const std::function<void()>&)>& around) {
  tools::Program program("reeb", "");
  kCommands.at(words[0])(program);
  CommandOutcome outcome;
  flush_standard_streams();
  const Redirected in(STDIN_FILENO, opened(input, O_RDONLY)), out(STDOUT_FILENO, checked(::memfd_create("", 0), "")),
      messages(STDERR_FILENO, opened("/dev/null", O_WRONLY));
  // CLI11 allocates in functions that may not throw, so faults begin when it has parsed the command line.
  program.before_commands([] { allocations_pass = false; });
  allocations_pass = true;
  try {
    around([&] { program.run(words); });
  } catch (const Error& error) {
    outcome = {static_cast<int>(error.kind()), error.message(), error.file(), error.hint(), {}};
  } catch (const std::bad_alloc&) {  // as the program says it
    outcome = {static_cast<int>(ErrorKind::kResource), "out of memory", {}, "close other programs", {}};
  }
  allocations_pass = false;
  flush_standard_streams();
  outcome.output = content_of(STDOUT_FILENO);
  return outcome;
}

}  // namespace reeb::test
