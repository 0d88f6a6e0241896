# What test scripts begin with: an empty working folder $work, removed at the end, and checks. A script ends with
# `exit $((failures > 0))`.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
check() {  # check WHAT COMMAND...: the command succeeds
  local what=$1
  shift
  if "$@" >log 2>&1; then echo "ok: $what"; else echo "FAILED: $what"; cat log; failures=$((failures + 1)); fi
}
by_pkg_config() {  # by_pkg_config CXX PKG_CONFIG_PATH: a program of another project, built with the library, runs
  cat >online.cpp <<'END'
#include "reeb/reeb.h"
int main() {
  reeb::OnlineReeb online;
  online.add_simplex({{online.add_vertex(0), online.add_vertex(1)}});
  return online.snapshot().arc_count() == 1 ? 0 : 1;
}
END
  "$1" -O0 online.cpp $(PKG_CONFIG_PATH=$2 pkg-config --cflags --libs --static reeb) -o online && ./online
}
