#!/usr/bin/env bash
# clang-tidy finds nothing, with the checks of .clang-tidy.
#
#   tests/house/tidy.sh [PATH...]
#
# PATH is a folder or file of the sources (libreeb io ooc tools). It takes a minute for about ten files, so it is no
# part of tests/run.sh; `ctest -C all -L slow` runs it. Other versions of clang-tidy than 14 differ.
set -euo pipefail
cd "$(dirname "$0")/../.."

if ! command -v clang-tidy-14 >/dev/null; then
  echo "skipped: clang-tidy-14 is not installed; apt-get install clang-tidy-14 installs it"
  exit 0
fi
cmake --preset release >/dev/null
[[ $# -gt 0 ]] || set -- libreeb io ooc tools
find "$@" -name '*.cpp' -print0 | sort -z |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-14 -p build/release --quiet 2> >(grep -v 'warnings\? generated' >&2)
