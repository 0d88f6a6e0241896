// What a user is told when a run ends early.
#pragma once

#include <exception>
#include <optional>

#include "libreeb/base/error.h"
#include "ooc/run/run_context.h"

namespace reeb::ooc {

// What to do about an error that no part of the program explains but a limit of the system: for instance, that a thread
// cannot be started. Of other errors: nothing.
std::optional<Error> error_of_limit(const std::exception& error);

// Throws the exception that is being handled again, as an Error that says whether --resume can continue. One that
// cannot be explained is thrown as it is. REQUIRES: called in a handler.
[[noreturn]] void throw_explained(RunContext& run);

}  // namespace reeb::ooc
