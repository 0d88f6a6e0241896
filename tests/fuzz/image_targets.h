// The targets for images.
#pragma once

#include <span>

#include "tests/fuzz/targets.h"

namespace reeb::test {

std::span<const FuzzTarget> image_fuzz_targets();

}  // namespace reeb::test
