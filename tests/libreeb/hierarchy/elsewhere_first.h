// A second thread that is always faster, without a thread.
#pragma once

#include <functional>

namespace reeb::test {

// A DoBoth (libreeb/base/work.h).
inline void elsewhere_first(const std::function<void()>& here, const std::function<void()>& elsewhere) {
  elsewhere();
  here();
}

}  // namespace reeb::test
