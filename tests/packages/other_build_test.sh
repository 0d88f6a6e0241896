#!/usr/bin/env bash
# The whole project built with other options: builds it, and runs all that the README shows against the installed copy.
# Takes minutes.
#
#   other_build_test.sh SOURCE_FOLDER CXX OPTION_OF_CMAKE...
set -euo pipefail
source=$1 cxx=$2
shift 2
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cd "$source"
cmake -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" "$@" -DREEB_TESTS=OFF -DREEB_BENCH=OFF >/dev/null
cmake --build "$build" >"$build/log" 2>&1 || { tail -50 "$build/log"; exit 1; }
bash "$source/tests/packages/readme_test.sh" "$source/README.md" "$build"
