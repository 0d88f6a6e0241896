// The targets for what is read besides meshes and graphs, and for the engine, which is compared with its definition.
#pragma once

#include <span>

#include "tests/fuzz/targets.h"

namespace reeb::test {

std::span<const FuzzTarget> inner_fuzz_targets();

}  // namespace reeb::test
