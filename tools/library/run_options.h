// The options of a run, as its rooms take them.
#pragma once

#include "ooc/run/compute.h"
#include "tools/library/compute.h"

namespace reeb {

// THROWS: Error{kUsage} for numbers out of the limits in compute.h.
void check_limits(const ComputeOptions& options);

// What calls back is called by one thread at a time.
ooc::ComputeOptions run_options(const ComputeOptions& options);

}  // namespace reeb
