// The options of a run, as its rooms take them.
#pragma once

#include "ooc/run/compute.h"
#include "tools/library/compute.h"

namespace reeb {

// What calls back is called by one thread at a time.
ooc::ComputeOptions run_options(const ComputeOptions& options);

}  // namespace reeb
