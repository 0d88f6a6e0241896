// The one exception of the project: what went wrong, where, and what the user can do about it.
//
// The program prints `reeb: error: FILE:POSITION: WHAT` and `hint: HINT`, and exits with the
// number of the kind. Broken preconditions inside the code are not Errors.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

namespace reeb {

// The values are exit codes; they are never reused.
enum class ErrorKind : int {
  kBadInput = 1,      // the input, or a file that the user names, is bad
  kUsage = 2,         // the command line is wrong
  kResource = 3,      // memory or disk ran out, or an output cannot be written
  kInterrupted = 130  // by a signal
};

// A plain value, like any exception.
class Error : public std::exception {
 public:
  Error(ErrorKind kind, std::string what, std::string hint);

  // Sets the file, and the byte offset ("12") or "line:column" in it. Either may be empty.
  // A layer that knows them calls this while the error passes through; what was set before stays.
  Error& at(const std::string& file, const std::string& position = {});

  ErrorKind kind() const { return kind_; }
  const std::string& file() const { return file_; }
  const std::string& position() const { return position_; }
  const std::string& message() const { return message_; }
  const std::string& hint() const { return hint_; }

  // "FILE:POSITION: WHAT", without the parts that are unknown. One line, safe to show (printable.h).
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  void compose();

  ErrorKind kind_;
  std::string file_, position_, message_, hint_, text_;
};

// What was read of an input does not fit together: it changed while it was read.
class InputChanged : public Error {
 public:
  explicit InputChanged(const std::string& what = "the mesh changed while it was read",
                        const std::string& hint = "run it again while no other program writes to the file");
};

// A surface that was said to be a manifold has a third triangle at the edge between two vertices.
class NotManifold : public Error {
 public:
  NotManifold(std::uint64_t a, std::uint64_t b);
};

}  // namespace reeb
