#!/usr/bin/env bash
# The whole project with shared libraries: builds it, and runs all that the README shows against the installed
# copy. Takes minutes.
#
#   shared_test.sh SOURCE_FOLDER CXX
set -euo pipefail
source=$1 cxx=$2
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DBUILD_SHARED_LIBS=ON -DREEB_TESTS=OFF -DREEB_BENCH=OFF >/dev/null
cmake --build "$build" >"$build/log" 2>&1 || { tail -50 "$build/log"; exit 1; }
bash "$source/tests/tools/readme_test.sh" "$source/README.md" "$build"
