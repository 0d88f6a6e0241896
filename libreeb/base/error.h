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

// What a caller may tell apart within a kind, whatever the message says.
enum class ErrorCause : std::uint8_t {
  kNone,         // none of these
  kMemory,       // memory, or the part of it that may be used, does not suffice
  kExists,       // an output exists, and may not be replaced
  kMissing,      // an input does not exist
  kChanged,      // what was read of an input does not fit together: it changed while it was read
  kUnreadable,   // an input that was open could not be read on: the disk or the connection failed
  kNotManifold,  // a surface that was said to be a manifold is none
};

// A plain value, like any exception.
class Error : public std::exception {
 public:
  Error(ErrorKind kind, std::string what, std::string hint);

  // Sets the file, and the byte offset ("12") or "line:column" in it. Either may be empty.
  // A layer that knows them calls this while the error passes through; what was set before stays.
  Error& at(const std::string& file, const std::string& position = {});
  Error& because(ErrorCause cause);
  // The same error with another hint.
  Error with_hint(std::string hint) const;

  ErrorKind kind() const { return kind_; }
  ErrorCause cause() const { return cause_; }
  const std::string& file() const { return file_; }
  const std::string& position() const { return position_; }
  const std::string& message() const { return message_; }
  const std::string& hint() const { return hint_; }

  // "FILE:POSITION: WHAT", without the parts that are unknown. One line, safe to show (printable.h).
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  void compose();

  ErrorKind kind_;
  ErrorCause cause_ = ErrorCause::kNone;
  std::string file_, position_, message_, hint_, text_;
};

// Error{kBadInput} of the cause kChanged.
Error input_changed(const std::string& what = "the mesh changed while it was read",
                    const std::string& hint = "run it again while no other program writes to the file");

// Error{kBadInput} of the cause kNotManifold: there is a third triangle at the edge between two vertices.
Error not_manifold(std::uint64_t a, std::uint64_t b);

}  // namespace reeb
