#!/usr/bin/env bash
# Installs what is missing, builds everything and runs all tests.
#
#   tests/run.sh [--preset release|asan|tsan|dev] [--label LABEL]
#
# The default preset is release. --label runs only the tests with that ctest label. REEB_CASES=N
# sets how many random cases the model tests try. The last line is `N passed, N failed`; the exit
# code is 0 only if nothing failed.
set -euo pipefail
cd "$(dirname "$0")/.."

preset=release
ctest_options=()
while [[ $# -gt 0 ]]; do
  case $1 in
    --preset | --label)
      [[ $# -ge 2 ]] || { echo "error: $1 needs a value" >&2; exit 2; }
      if [[ $1 == --preset ]]; then preset=$2; else ctest_options+=(-L "^$2\$"); fi
      shift 2 ;;
    -h | --help) sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) echo "error: unknown option $1; see $0 --help" >&2; exit 2 ;;
  esac
done
case $preset in
  release | asan | tsan | dev) ;;
  *) echo "error: no preset $preset; there are release, asan, tsan and dev" >&2; exit 2 ;;
esac

jobs=$(nproc)
step() { printf '== %s (%d s)\n' "$1" "$SECONDS"; }

step "packages"
tools/install_packages.sh tests
step "configure, preset $preset"
mkdir -p "build/$preset"
cmake --preset "$preset" -DREEB_WERROR=ON >"build/$preset/configure-log.txt" 2>&1 ||
  { cat "build/$preset/configure-log.txt"; exit 1; }
step "build with $jobs jobs"
NINJA_STATUS='[%f/%t] ' cmake --build --preset "$preset" -j "$jobs"
step "test"
log=build/$preset/test-log.txt
status=0
ctest --preset "$preset" -j "$jobs" --no-tests=error "${ctest_options[@]}" </dev/null 2>&1 | tee "$log" ||
  status=$?

# ctest's own count: "97% tests passed, 1 tests failed out of 34". Skipped ones count as passed.
read -r failed total < <(sed -n 's/.*tests passed, \([0-9]*\) tests failed out of \([0-9]*\).*/\1 \2/p' "$log") || true
step "done"
if [[ -z ${total:-} ]]; then
  echo "0 passed, 1 failed"
  exit 1
fi
echo "$((total - failed)) passed, $failed failed"
exit "$status"
