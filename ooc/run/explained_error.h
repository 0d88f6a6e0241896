// What a user is told when a run ends early.
#pragma once

#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Throws the exception that is being handled again, as an Error that says whether --resume can continue. One that
// cannot be explained is thrown as it is. REQUIRES: called in a handler.
[[noreturn]] void throw_explained(RunContext& run);

}  // namespace reeb::ooc
