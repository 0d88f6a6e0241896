#!/usr/bin/env bash
# The whole project with shared libraries: builds it, and runs all that the README shows against the installed
# copy. Takes minutes, though nothing is optimized.
#
#   shared_test.sh SOURCE_FOLDER CXX
set -euo pipefail
source=$1 cxx=$2
build=$(mktemp -d)
trap 'rm -rf "$build"' EXIT
cmake -S "$source" -B "$build" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" -DBUILD_SHARED_LIBS=ON \
  -DREEB_TESTS=OFF -DREEB_BENCH=OFF -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 >/dev/null
cmake --build "$build" >"$build/log" 2>&1 || { tail -50 "$build/log"; exit 1; }
bash "$source/tests/tools/readme_test.sh" "$source/README.md" "$build"
