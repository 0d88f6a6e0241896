#include "tools/plot/child_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <span>
#include <system_error>

#include "io/file/temp_dir.h"
#include "libreeb/base/error.h"
#include "libreeb/base/printable.h"
#include "tools/program/signals.h"

namespace reeb::tools {
namespace {

std::string content_of(const io::File& file) {
  std::string bytes(static_cast<std::size_t>(file.size()), '\0');
  file.read_at(0, std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

// What a program complained about, in one line.
std::string first_complaint(const std::string& text) {
  constexpr std::size_t kMost = 200;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line.find_first_not_of(" \t\r^") != std::string::npos) return ": " + line.substr(0, kMost);
    at = end + 1;
  }
  return {};
}

// THROWS: Error{kResource}. Returns what waitpid says.
int run_to_its_end(const std::string& path, const std::vector<std::string>& arguments, const io::File& input,
                   const io::File& output, const io::File& complaints) {
  const StartedChild child =
      start_child({path, arguments, {input.descriptor(), output.descriptor(), complaints.descriptor()}});
  if (child.error != 0)
    throw Error(ErrorKind::kResource, "cannot be started: " + std::generic_category().message(child.error),
                "check that this file can be run, and that memory and processes are left")
        .at(path);
  int status = 0;
  while (::waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  forget_child();
  return status;
}

}  // namespace

std::string find_program(const ChildProgram& program) {
  const char* const variable = std::getenv("PATH");
  const std::string folders = variable == nullptr ? "" : variable;
  for (std::size_t at = 0; at < folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    const std::string path = folders.substr(at, end - at) + '/' + program.name;
    if (end > at && ::access(path.c_str(), X_OK) == 0) return path;
    at = end + 1;
  }
  throw Error(ErrorKind::kResource, std::string("the program ") + program.name + " is needed for this, and is missing",
              std::string("install the package ") + program.package + ": apt-get install " + program.package);
}

std::string run_program(const ChildProgram& program, const std::vector<std::string>& arguments, std::string_view input,
                        const std::string& temp_folder) {
  const std::string path = find_program(program);
  const io::TempDir folder(temp_folder);
  const io::File in = folder.create_unnamed("input"), out = folder.create_unnamed("output"),
                 complaints = folder.create_unnamed("messages");
  in.write_at(0, std::as_bytes(std::span(input)));
  const int status = run_to_its_end(path, arguments, in, out, complaints);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && out.size() != 0) return content_of(out);
  const std::string what = WIFSIGNALED(status)
                               ? std::string("was ended by the signal \"") + ::strsignal(WTERMSIG(status)) + '"'
                               : "failed" + printable(first_complaint(content_of(complaints)));
  throw Error(ErrorKind::kResource, std::string(program.name) + ' ' + what,
              std::string("check that memory is left, and that `") + program.name + "` of the package " +
                  program.package + " works");
}

}  // namespace reeb::tools
