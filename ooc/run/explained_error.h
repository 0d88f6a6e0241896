// What a user is told when a run ends early.
#pragma once

#include "ooc/run/run_context.h"

namespace reeb::ooc {

// Throws the exception that is being handled, with what it means for this run: whether --resume can continue, and in
// words what is no Error. REQUIRES: called in a handler.
[[noreturn]] void throw_explained(RunContext& run);

}  // namespace reeb::ooc
